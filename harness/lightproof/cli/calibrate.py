"""measure each renderer's units: the power of a light of each kind in a black box, kept for every version"""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console
from rich.markup import escape

from lightproof import suite
from lightproof.cli import run as runs
from lightproof.cli.status import UsageError
from lightproof.judging import homes


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which methods, for how long."""
    add = parser.add_argument
    add("methods", nargs="*", metavar="METHOD", help="as for run --with (default: each renderer's best configuration)")
    add("--budget", type=runs.seconds, default=120.0, metavar="S", help="of the run that measures (default: %(default)g s)")
    add("--out", type=Path, default=runs.RUNS, metavar="DIR", help="where that run's folder is made (default: %(default)s)")


def run(options: argparse.Namespace) -> int:
    """Render every wall of the boxes, keep the factors, and say each."""
    from lightproof.reporting import units  # pandas takes a second that the other commands need not wait
    from lightproof.reporting.evaluation import evaluate

    console, known = Console(emoji=False, highlight=False, soft_wrap=True), units.read(units.FILE)
    boxes = [scene.name for scene in suite.default().cases(units.SCENE).values()]
    planned = {**vars(runs.defaults()), **vars(options), "scenes": boxes}
    record, status = runs.new(argparse.Namespace(**planned), console)
    factors = units.measure(evaluate(record, homes(record)))
    try:
        units.keep(units.FILE, factors)
    except OSError as error:
        raise UsageError(f"{units.FILE}: cannot be written ({error.strerror}); mend that and calibrate again") from None
    for factor in factors:
        console.print(f"{escape(factor.method)} {escape(factor.version)}: {factor.light} light {units.shown(factor)}")
    for alarm in units.alarms(known, factors):
        console.print(f"[red]alarm[/] {escape(alarm.now.method)}: {escape(alarm.message)}")
    return status
