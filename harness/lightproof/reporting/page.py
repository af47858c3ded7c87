"""index.html: one file that holds everything and opens offline."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from subprocess import SubprocessError
from typing import Any

import jinja2
import vl_convert
from markupsafe import Markup

from lightproof.method import Unavailable
from lightproof.reporting import charts, theory, units, wording
from lightproof.reporting.citations import Citation
from lightproof.reporting.colours import shrunk
from lightproof.reporting.evaluation import Cell, Evaluation
from lightproof.reporting.families import families, singly
from lightproof.reporting.scene_view import SceneView
from lightproof.reporting.tables import samples_per_second
from lightproof.reporting.units import Factor
from lightproof.scene import Scene
from lightproof.verdict import Outcome, Step

ICONS = {"pass": "✓", "fail": "✕", "undecided": "?", "unsupported": "–", "error": "!", "no-reference": "∅"}
JUDGED = (Outcome.PASS, Outcome.FAIL, Outcome.UNDECIDED)
DOUBTS = {Outcome.FAIL: "wrong", Outcome.UNDECIDED: "undecided"}
OTHERWISE = {Outcome.UNSUPPORTED: "unsupported", Outcome.ERROR: "ended in an error", Outcome.NO_REFERENCE: "without a reference"}


def render(evaluation: Evaluation, bibliography: Mapping[str, Citation], picture: Callable[[Scene], bytes],
           factors: Sequence[Factor] = (), fast: Sequence[str] = ()) -> str:
    """The whole page. `picture` gives a scene's set-up as PNG bytes; where it raises, the page says why there is none.
    `factors` are the units of renderers as they were measured, in that order; `fast` says in sentences what is fastest, where the
    speed page says more."""
    views = [_view(evaluation, scene, bibliography, picture) for scene in evaluation.scenes]
    counts = Counter(cell.verdict.outcome for cell in evaluation.cells)
    now = units.current(factors, evaluation.run.versions)
    return environment().get_template("page.html.j2").render(
        evaluation=evaluation,
        run=evaluation.run,
        views=views,
        families=families(evaluation.methods),
        singly=singly(evaluation.methods),
        counts=counts,
        answer=answer(counts),
        findings=findings(evaluation),
        factors=now,
        lights=sorted({factor.light for factor in now}),
        alarms=units.alarms(factors, now),
        cost=charts.time_to_one_percent(evaluation.cells, evaluation.methods),
        fast=fast,
        bundle=bundle(),
    )


@cache
def bundle() -> Markup:
    """Vega, Vega-Lite and their embedding, for the page's one script."""
    return Markup(vl_convert.javascript_bundle())


def _view(evaluation: Evaluation, scene: Scene, bibliography: Mapping[str, Citation],
          picture: Callable[[Scene], bytes]) -> SceneView:
    cells = [cell for method in evaluation.methods if (cell := evaluation.cell(scene, method))]
    try:
        image, missing = shrunk(picture(scene)), ""
    except (Unavailable, RuntimeError, OSError, SubprocessError) as reason:
        image, missing = "", str(reason)
    return SceneView(scene, cells, evaluation.methods, image, missing, bibliography)


def environment() -> jinja2.Environment:
    """What the templates know."""
    made = jinja2.Environment(
        loader=jinja2.PackageLoader("lightproof.reporting"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        finalize=_finalize,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    spoken = ("number", "percent", "seconds", "count", "moment", "triangles", "unbroken")
    made.filters |= {name: getattr(wording, name) for name in spoken}
    own = (theory.slope, time_to, error_at, bias, worst_tile, units.shown)
    made.filters |= {filter.__name__: filter for filter in own}
    made.globals |= {"icons": ICONS, "samples_per_second": samples_per_second}
    return made


def _finalize(value: Any) -> Any:
    return wording.printable(value) if isinstance(value, str) and not isinstance(value, Markup) else value


def answer(counts: Mapping[Outcome, int]) -> str:
    """The run in one sentence."""
    judged = sum(counts[outcome] for outcome in JUDGED)
    others = [f"{counts[outcome]} {word}" for outcome, word in OTHERWISE.items() if counts[outcome]]
    if not judged:
        return f"Nothing could be judged: {', '.join(others) or 'the run is empty'}."
    right = f"In {counts[Outcome.PASS]} of {judged} judged cases the light is right"
    doubts = [f"in {counts[outcome]} it is {word}" for outcome, word in DOUBTS.items() if counts[outcome]]
    return f"{', '.join([right, *doubts])}{'; ' if others else ''}{', '.join(others)}."


def findings(evaluation: Evaluation) -> list[Cell]:
    """What a reader must hear of: wrong light, failures to answer, true biases within the tolerance; in this order."""
    grave = (Outcome.FAIL, Outcome.ERROR, Outcome.NO_REFERENCE, Outcome.PASS)
    found = [cell for cell in evaluation.cells if cell.verdict.biased or cell.verdict.outcome in grave[:-1]]
    return sorted(found, key=lambda cell: grave.index(cell.verdict.outcome))


def time_to(cell: Cell, error: float) -> str:
    """Render time until a single film's rms error is `error`; a bound where the ladder began below it or never came so far."""
    steps = cell.verdict.steps
    if not cell.timed:
        return "time unknown"
    found = cell.seconds_to(error)
    if found is None:
        return f"> {wording.seconds(max(step.seconds_render for step in steps))}"
    return f"{'≤ ' if steps[0].rmse <= error else ''}{wording.seconds(found)}"


def error_at(cell: Cell, element: int) -> str:
    """One element's error in per cent of the tolerance scale, ± a standard error where there is one."""
    if cell.deviation is None:
        return wording.percent(cell.error[element])
    half = cell.deviation[element]
    return wording.interval(cell.error[element] - half, cell.error[element] + half)


def bias(step: Step) -> str:
    """The film mean's bias with its interval."""
    return wording.interval(step.bias_low, step.bias_high)


def worst_tile(step: Step) -> str:
    """The bias of the tile furthest off, with its interval."""
    return wording.interval(step.worst_tile_low, step.worst_tile_high)
