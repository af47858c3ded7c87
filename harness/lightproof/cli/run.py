"""render the suite, or some scenes with some methods, and record everything measured"""

from __future__ import annotations

import argparse
import math
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from rich.console import Console
from rich.markup import escape

from lightproof import machine, plan, store, suite
from lightproof.cli import selection
from lightproof.cli.progress import Display
from lightproof.cli.status import DONE, FAILED, INCOMPLETE, UsageError
from lightproof.judging import Judge
from lightproof.method import Unavailable
from lightproof.renderers.pool import MethodFailed, Pool
from lightproof.renderers.process import WorkerDied
from lightproof.renderers.registry import Entry
from lightproof.runner import REPLICATES, Runner
from lightproof.store import Store
from lightproof.suite import Suite
from lightproof.verdict import Outcome, Verdict

RUNS = Path("reports/runs")
PLAN = ("scenes", "methods", "tags", "budget", "cell_budget", "replicates", "threads", "seed", "out", "suite")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Scenes, methods, budgets."""
    add = parser.add_argument
    add("scenes", nargs="*", metavar="SCENE", help="id, id:case or path of a .toml file (default: all that are quick)")
    add("--with", dest="methods", nargs="+", action="extend", default=[], metavar="METHOD",
        help="name, glob, module:name, file.py:name or manifest.toml (default: each renderer's best configuration)")
    add("--tags", nargs="+", action="extend", default=[], metavar="TAG",
        help="scenes with one of these; nightly: every case of every scene, every configuration")
    add("--budget", type=seconds, default=900.0, metavar="S", help="of the whole run (default: %(default)g s)")
    add("--cell-budget", type=seconds, default=240.0, metavar="S", help="of a scene and method (default: %(default)g s)")
    add("--replicates", type=count(2), default=REPLICATES, metavar="N", help="films a step (default: the rule's %(default)s)")
    add("--threads", type=count(1), default=machine.usable_cores(), metavar="N", help="default: all cores, %(default)s here")
    add("--seed", type=count(0), default=0, metavar="N", help="another seed, other noise (default: %(default)s)")
    add("--out", type=Path, default=RUNS, metavar="DIR", help="where the run's folder is made (default: %(default)s)")
    add("--suite", type=Path, metavar="DIR", help="a folder with scenes/ and references/ (default: Lightproof's own)")
    add("--resume", type=Path, metavar="RUN",
        help="carry on with the run in this folder, which is one of your own: it names the code that runs")
    add("--strict", action="store_true", help="exit 1 where a verdict is fail, 3 where one is undecided")


def positive(name: str):
    """A reader of numbers greater than 0."""

    def read(text: str) -> float:
        value = float(text)
        if not 0 < value < math.inf:
            raise argparse.ArgumentTypeError(f"{text} is out of range; give a {name} greater than 0")
        return value

    read.__name__ = name
    return read


def count(least: int):
    """A reader of whole numbers from `least`."""

    def read(text: str) -> int:
        value = int(text)
        if not least <= value < 2**31:
            raise argparse.ArgumentTypeError(f"{text} is out of range; give a whole number of at least {least}")
        return value

    read.__name__ = "whole number"
    return read


seconds = positive("number of seconds")


def run(options: argparse.Namespace) -> int:
    """Make or resume a run, and sum it up."""
    console = Console(emoji=False, highlight=False, soft_wrap=True)
    if options.resume:
        return _resume(options, console)
    return new(options, console)[1]


def new(options: argparse.Namespace, console: Console) -> tuple[Store, int]:
    """A new run, carried out: its record and the exit status. Raises UsageError, SceneError, StoreError."""
    home = Suite(options.suite) if options.suite else suite.default()
    scenes = selection.scenes(options.scenes, options.tags, home)
    methods = selection.methods(options.methods, options.tags)
    store.check_writable(options.out)
    with Pool(options.threads) as pool:
        header = plan.describe(scenes, methods, options.threads, options.seed, _open(methods, pool, console),
                               **{name: getattr(options, name) for name in ("budget", "cell_budget", "replicates", "tags")})
        record = store.create(options.out, header, list(scenes))
        return record, _carry_out(record, pool, console, options.strict)


def _resume(options: argparse.Namespace, console: Console) -> int:
    changed = [name for name in PLAN if getattr(options, name) != getattr(defaults(), name)]
    if changed:
        raise UsageError(f"--resume carries on with the plan of the run; leave out {', '.join(changed)}")
    record = store.open(options.resume)
    with Pool(record.run.threads) as pool:
        return _carry_out(record, pool, console, options.strict)


def defaults() -> argparse.Namespace:
    """The options of a run that was given none."""
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    return parser.parse_args([])


def _open(methods: Iterable[Entry], pool: Pool, console: Console) -> dict[str, str]:
    """Versions of the methods that start; says of the others what is wrong."""
    versions = {}
    for entry in methods:
        try:
            versions[entry.name] = pool.open(entry).version
        except (Unavailable, MethodFailed, WorkerDied) as error:
            console.print(f"[yellow]{escape(entry.name)}[/]: {escape(str(error))}")
    return versions


def _carry_out(record: Store, pool: Pool, console: Console, strict: bool) -> int:
    cells, judge = plan.cells(record), Judge(record)
    try:
        with Display(console) as display:
            Runner(cells, record.run.options["budget"], record, pool, judge.decide, display.show).run()
    except KeyboardInterrupt:
        console.print(f"interrupted; carry on with: lightproof run --resume {escape(str(record.folder))}")
        return INCOMPLETE
    verdicts = {cell.name: judge.judge(cell.results) for cell in cells if cell.results}
    _sum_up(verdicts, console)
    console.print(f"recorded in {escape(str(record.folder))}")
    complete = all(cell.results and cell.entry.name in record.run.versions for cell in cells)
    return exit_status([verdict.outcome for verdict in verdicts.values()], strict, complete)


def _sum_up(verdicts: dict[str, Verdict], console: Console) -> None:
    alike: dict[tuple[Outcome, str], list[str]] = {}
    for name, verdict in verdicts.items():
        if verdict.outcome in (Outcome.FAIL, Outcome.ERROR):
            alike.setdefault((verdict.outcome, verdict.reason), []).append(name)
    for (outcome, reason), names in alike.items():
        console.print(f"[red]{outcome}[/] {escape(', '.join(names))}: {escape(reason)}")
    counts = Counter(verdict.outcome for verdict in verdicts.values())
    console.print(", ".join(f"{counts[outcome]} {outcome}" for outcome in Outcome if counts[outcome]))


def exit_status(outcomes: Sequence[Outcome], strict: bool, complete: bool) -> int:
    """0 where the job is done, 3 where something broke; strictly 1 where something fails, 3 where anything else is not passed or
    the run is not `complete`: a method did not start, or a cell has no result. What a method cannot do counts neither way."""
    if strict and Outcome.FAIL in outcomes:
        return FAILED
    unwanted = {Outcome.ERROR, Outcome.UNDECIDED, Outcome.NO_REFERENCE} if strict else {Outcome.ERROR}
    return INCOMPLETE if (strict and not complete) or unwanted & set(outcomes) else DONE
