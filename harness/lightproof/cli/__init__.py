"""Command line: one module a command, each with `add_arguments(parser)` and `run(options) -> exit status`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from lightproof.baseline import BaselineError
from lightproof.checked import SceneError, plain
from lightproof.cli import calibrate, certify, doctor, export, gate, grade, listing, report, run
from lightproof.cli.status import INCOMPLETE, USAGE, UsageError
from lightproof.films import FilmError
from lightproof.renderers.naming import MethodError
from lightproof.store import StoreError

COMMANDS = {
    "run": run, "report": report, "list": listing, "certify": certify, "doctor": doctor, "gate": gate, "export": export,
    "grade": grade, "calibrate": calibrate,
}

LONGEST_COMPLAINT = 10_000


def parser() -> argparse.ArgumentParser:
    """The parser of the whole command line."""
    whole = argparse.ArgumentParser(prog="lightproof", description="Is a renderer's light right, and what does it cost in time?")
    commands = whole.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, module in COMMANDS.items():
        module.add_arguments(commands.add_parser(name, help=module.__doc__, description=module.__doc__))
    return whole


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command. The exit status is 2 for bad input and 3 where the job could not be completed."""
    options = parser().parse_args(arguments)
    try:
        return COMMANDS[options.command].run(options)
    except (UsageError, SceneError, MethodError, StoreError, FilmError, BaselineError) as error:
        print(f"lightproof {options.command}: {plain(str(error), LONGEST_COMPLAINT)}", file=sys.stderr)
        return USAGE
    except KeyboardInterrupt:
        print(f"lightproof {options.command}: interrupted", file=sys.stderr)
        return INCOMPLETE
