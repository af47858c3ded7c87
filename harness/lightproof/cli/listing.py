"""show scenes and methods, and what they are for"""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from lightproof import suite
from lightproof.cli.status import DONE
from lightproof.renderers.registry import METHODS
from lightproof.suite import Suite


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which suite."""
    parser.add_argument("--suite", type=Path, metavar="DIR", help="a folder with scenes/ (default: Lightproof's own)")


def run(options: argparse.Namespace) -> int:
    """Print two tables."""
    console = Console()
    console.print(_scenes(Suite(options.suite) if options.suite else suite.default()))
    console.print(_methods())
    return DONE


def _scenes(root: Suite) -> Table:
    table = Table("scene", "cases", "tags", "what it tests", title="Scenes", title_justify="left")
    for name in root.ids:
        cases = root.cases(name)
        base = next(iter(cases.values()))
        table.add_row(*map(Text, (name, ", ".join(cases), ", ".join(base.tags), base.tests or base.title)))
    return table


def _methods() -> Table:
    table = Table("method", "installed with", "runs", title="Methods", title_justify="left")
    for entry in METHODS.values():
        install = f"pip install 'lightproof[{entry.extra}]'" if entry.extra else "always there"
        table.add_row(*map(Text, (entry.name, install, "nightly" if entry.nightly else "by default")))
    return table
