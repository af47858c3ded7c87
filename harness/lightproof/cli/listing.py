"""show scenes and methods, and what they are for"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

from rich.console import Console
from rich.table import Column, Table
from rich.text import Text

from lightproof import suite
from lightproof.cli.selection import NIGHTLY, QUICK, check_tags
from lightproof.cli.status import DONE, UsageError
from lightproof.renderers.registry import METHODS, family
from lightproof.scene import TAGS, Scene
from lightproof.suite import Suite

GROUPS = tuple(tag for tag in TAGS if tag not in (QUICK, NIGHTLY))
EXTRAS = Text("An extra is installed with, for one, pip install 'lightproof[cycles]', all with pip install 'lightproof[all]'.")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which scenes of which suite."""
    parser.add_argument("--tags", nargs="+", action="extend", default=[], metavar="TAG", help=f"of {', '.join(TAGS)}")
    parser.add_argument("--suite", type=Path, metavar="DIR", help="a folder with scenes/ (default: Lightproof's own)")


def run(options: argparse.Namespace) -> int:
    """Print the scenes group by group, then the methods."""
    check_tags(options.tags)
    console = Console(emoji=False)
    scenes = _chosen(Suite(options.suite) if options.suite else suite.default(), options.tags)
    for group, members in groupby(sorted(scenes, key=_rank), key=_group):
        console.print(_scenes(group, list(members)))
    console.print(_methods())
    return DONE


def _chosen(root: Suite, tags: Sequence[str]) -> list[list[Scene]]:
    """The cases of every scene that carries one of the tags; of all without tags, or for the tag nightly."""
    every = [list(root.cases(name).values()) for name in root.ids]
    wanted = set(tags) - {NIGHTLY}
    chosen = [cases for cases in every if not wanted or wanted & set(cases[0].tags)]
    if not chosen:
        raise UsageError(f"no scene carries the tag {' or '.join(sorted(wanted))}")
    return chosen


def _group(cases: Sequence[Scene]) -> str:
    """The first of a scene's tags that says what kind of light it is about."""
    return next((tag for tag in cases[0].tags if tag in GROUPS), "other")


def _rank(cases: Sequence[Scene]) -> tuple[int, str]:
    group = _group(cases)
    return (GROUPS.index(group) if group in GROUPS else len(GROUPS)), cases[0].id


def _scenes(group: str, members: Sequence[Sequence[Scene]]) -> Table:
    table = Table("scene", "cases", "tags", "what it tests", title=f"Scenes: {group}", title_justify="left")
    for cases in members:
        base = cases[0]
        names = ", ".join(case.case for case in cases)
        table.add_row(*map(Text, (base.id, names, ", ".join(base.tags), base.tests or base.title)))
    return table


def _methods() -> Table:
    """A row a family; only what has no option runs by default."""
    table = Table(Column("method", no_wrap=True), "options, as in mitsuba/sobol", "extra", "runs", title="Methods",
                  title_justify="left", caption=EXTRAS, caption_justify="left")
    for name, members in groupby(METHODS.values(), key=lambda entry: family(entry.name)):
        bare, *others = members
        options = ", ".join(entry.name.partition("/")[2] for entry in others)
        table.add_row(*map(Text, (name, options, bare.extra, "nightly" if bare.nightly else "by default")))
    return table
