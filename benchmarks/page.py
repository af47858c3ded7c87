"""The page of the benchmarks: one file that holds everything and opens offline."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

import jinja2
import vl_convert
from markupsafe import Markup

from claims import LEAST, MET, MISSED, OPEN, UNMEASURED, Claim, claims
from ladders import EXTRAPOLATED
from lightproof.reporting import wording
from rows import Row
from sections import SECTIONS, interval

BADGES = {MET: "pass", MISSED: "fail", OPEN: "undecided", UNMEASURED: "unsupported"}  # the report's colours
TEMPLATES = Path(__file__).parent / "templates"


def render(rows: Sequence[Row], about: Mapping[str, str]) -> str:
    """The whole page from the rows alone; `about` is what there is to say of the run."""
    found = claims(rows)
    own = {name: [row for row in rows if row.bench == name] for name in SECTIONS}
    sections = {name: (lead, build(own[name])) for name, (lead, build) in SECTIONS.items() if own[name]}
    return _environment().get_template("benchmarks.html.j2").render(
        answer=answer(found), about=about, claims=[(claim, cells(claim)) for claim in found], badges=BADGES, sections=sections,
        left_out=[row for row in rows if row.note and math.isnan(row.median)], bundle=Markup(vl_convert.javascript_bundle()))


def _environment() -> jinja2.Environment:
    loader = jinja2.ChoiceLoader([jinja2.FileSystemLoader(TEMPLATES), jinja2.PackageLoader("lightproof.reporting")])
    return jinja2.Environment(loader=loader, autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True,
                              lstrip_blocks=True)


def answer(found: Sequence[Claim]) -> str:
    """The run in one sentence."""
    counts = Counter(claim.outcome for claim in found if claim.target is not None)
    said = ", ".join(f"{counts[outcome]} {outcome}" for outcome in BADGES if counts[outcome])
    return f"Of {sum(counts.values())} claims about speed: {said}." if counts else "Nothing was measured that a claim is about."


def cells(claim: Claim) -> list[str]:
    """A claim as the cells of a table: text, scene, target, measured, interval, outcome."""
    target = "" if claim.target is None else f"{'≥' if claim.sense == LEAST else '≤'} {wording.number(claim.target)}"
    known = f", {EXTRAPOLATED}" if claim.extrapolated else ""
    measured = "" if math.isnan(claim.measured.value) else f"{claim.sign}{wording.number(claim.measured.value)}{known}"
    text = f"{claim.text} ({claim.note})" if claim.note else claim.text
    return [text, claim.scene, target, measured, interval(claim.measured), claim.outcome]
