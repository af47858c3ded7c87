"""judge a run and make its page"""

from __future__ import annotations

import argparse
from pathlib import Path

from lightproof import store
from lightproof.cli.run import RUNS
from lightproof.cli.status import DONE, UsageError
from lightproof.judging import homes
from lightproof.suite import Suite


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which run."""
    parser.add_argument("run", nargs="?", metavar="RUN", help=f"folder of a run, or its id in {RUNS} (default: the latest there)")
    parser.add_argument("--suite", type=Path, metavar="DIR", help="where the references are (default: where the scenes were)")


def run(options: argparse.Namespace) -> int:
    """Write the page and print its path."""
    record = _find(options.run)
    from lightproof import reporting  # pandas and altair take a second that the other commands need not wait

    try:
        print(reporting.write(record.folder, Suite(options.suite) if options.suite else homes(record)))
    except OSError as error:
        raise UsageError(f"{error.filename}: cannot be written ({error.strerror}); the page goes into the run's folder") from None
    return DONE


def _find(name: str | None) -> store.Store:
    if name is None:
        return store.latest(RUNS)
    return store.open(RUNS / name if not Path(name).exists() and (RUNS / name).exists() else Path(name))
