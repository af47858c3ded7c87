"""check the references, then judge the suite with fixed seeds against the accepted state: has anything become worse?"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path

from rich.console import Console
from rich.markup import escape

from lightproof import baseline, gate, machine, store, suite
from lightproof.baseline import Key, State
from lightproof.cli.checkup import checkup
from lightproof.cli.progress import Display
from lightproof.cli.run import count
from lightproof.cli.status import FAILED, UsageError
from lightproof.gate import Gate, Report
from lightproof.suite import Suite

BASELINE = Path("reports/baseline.csv")
STATE = Path("reports/state")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which rows, against which baseline."""
    add = parser.add_argument
    add("scenes", nargs="*", metavar="SCENE", help="only the rows of these scenes, ids or globs (default: every row)")
    add("--with", dest="methods", nargs="+", action="extend", default=[], metavar="METHOD", help="only those of these methods")
    add("--baseline", type=Path, default=BASELINE, metavar="FILE", help="the accepted state (default: %(default)s)")
    add("--run", dest="record", type=Path, metavar="RUN", help="judge this stored run instead of rendering anew")
    add("--out", type=Path, default=STATE, metavar="DIR", help="where the new state and the difference go (default: %(default)s)")
    add("--suite", type=Path, metavar="DIR", help="a folder with scenes/ and references/ (default: Lightproof's own)")
    add("--threads", type=count(1), default=machine.usable_cores(), metavar="N", help="default: all cores, %(default)s here")


def run(options: argparse.Namespace) -> int:
    """Print what is worse, and write the new state beside the old one for review."""
    console = Console(emoji=False, highlight=False, soft_wrap=True)
    accepted = {} if options.record and not options.baseline.exists() else baseline.read(options.baseline)
    store.check_writable(options.out)
    home = Suite(options.suite) if options.suite else suite.default()
    references = checkup((scene, home) for scene in home.scenes())
    console.print("\n".join([*references.complaints, references.summary]), markup=False)
    with Display(console) as display:
        judged = Gate(home, options.out, options.threads, display.show)
        if options.record:
            report = judged.check_run(store.open(options.record), accepted)
        else:
            report = judged.check(_selected(accepted, options.scenes, options.methods))
    _print(report, console)
    _propose(report, accepted, options.baseline, options.out, console)
    return FAILED if references.complaints else report.exit_status


def _selected(accepted: Mapping[Key, State], scenes: Sequence[str], methods: Sequence[str]) -> dict[Key, State]:
    """The rows that globs over scenes and methods choose; all of them without globs. Raises UsageError where there is none."""
    chosen = baseline.select(accepted, scenes, methods)
    if not chosen:
        raise UsageError("the baseline has no such row; leave out SCENE and --with to judge every row of it")
    return chosen


def _print(report: Report, console: Console) -> None:
    for finding in report.findings:
        console.print(f"[red]worse[/] {escape(finding.message)}")
    for state in report.undecided:
        console.print(f"[yellow]{state.outcome}[/] {escape(state.name)}")
    for reason in report.missing:
        console.print(f"[yellow]not run[/] {escape(reason)}")
    console.print(f"{len(report.states)} rows judged, {len(report.findings)} worse than the baseline")


def _propose(report: Report, accepted: Mapping[Key, State], old: Path, folder: Path, console: Console) -> None:
    proposed = folder / "baseline.csv"
    proposed.write_text(gate.proposal(report, accepted), encoding="utf-8")
    difference = baseline.difference(old, proposed)
    (folder / "baseline.diff").write_text(difference, encoding="utf-8")
    if difference:
        console.print(f"the new state differs: {escape(str(folder / 'baseline.diff'))}; accept it with: cp {proposed} {old}")
