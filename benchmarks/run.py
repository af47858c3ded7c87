"""Every claim about speed, measured in one run: a CSV, a page and a table of what was met.

    python benchmarks/run.py                      # all parts, about half an hour
    python benchmarks/run.py --only growth cache  # some of them
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

from rich.console import Console
from rich.table import Table as Shown

import accuracy
import cache
import growth
import hardware
import page
import throughput
from claims import Claim, claims
from lightproof import machine
from lightproof.renderers.pool import Pool
from race import Track
from rows import Table

PARTS = {part.NAME: part for part in (throughput, accuracy, hardware, growth, cache)}
FOLDER = Path(__file__).resolve().parents[1] / "reports" / "benchmarks"
WIDE = 150  # columns of the claims in a pipe
LOUD = Console(stderr=True)


def main() -> int:
    """0 when every part was measured, 3 when not."""
    options = arguments()
    with Table(options.out / "benchmarks.csv") as table:
        left_out: dict[str, str] = {}
        whole = measured(options, table, left_out)
        (options.out / "index.html").write_text(page.render(list(table), about(options) | left_out), encoding="utf-8")
        show(claims(list(table)), Console() if sys.stdout.isatty() else Console(width=WIDE))
    print(f"{options.out / 'index.html'}\n{options.out / 'benchmarks.csv'}")
    return 0 if whole else 3


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=PARTS, default=[*PARTS], help="parts (default: all)")
    parser.add_argument("--all", action="store_true", help="accuracy on the whole catalogue, not on its quick base cases alone")
    parser.add_argument("--rounds", type=int, default=7, help="of each measurement (default: %(default)s)")
    parser.add_argument("--seconds", type=float, default=0.5, help="that a renderer's film may take (default: %(default)s)")
    parser.add_argument("--threads", type=int, default=machine.usable_cores(), help="of every method (default: %(default)s)")
    parser.add_argument("--quick", action="store_true", help="a little of everything, to see that it works")
    parser.add_argument("--out", type=Path, default=FOLDER, help="folder for page and CSV (default: %(default)s)")
    return parser.parse_args()


def measured(options: argparse.Namespace, table: Table, left_out: dict[str, str]) -> bool:
    """Measure part by part; whether none broke and nobody interrupted. What was measured is in the table in any case, and what
    is not installed in `left_out`."""
    whole = True
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        counts = sorted({1, options.threads, *(2**power for power in range(1, 10) if 2**power < options.threads)})
        tracks = {count: Track(stack.enter_context(Pool(count)), folder, tell, options.seconds) for count in counts}
        for name, part in parts(options, tracks).items():
            tell(f"{name}: begins")
            try:
                part(tracks[options.threads], table.add, options.rounds, options.quick)
            except KeyboardInterrupt:
                tell("interrupted: the page has what was measured")
                return False
            except Exception as error:  # of one part: the others are still worth their time
                whole = False
                tell(f"{name}: {type(error).__name__}: {error}")
            left_out |= tracks[options.threads].left_out
    return whole


def about(options: argparse.Namespace) -> dict[str, str]:
    """What the page says of the run."""
    moment = f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC"
    return {"Machine": f"{machine.description()}, {options.threads} threads", "Finished": moment, "Rounds": str(options.rounds),
            "Commit": machine.commit() or "none", "Parts": ", ".join(options.only)}


def parts(options: argparse.Namespace, tracks: dict[int, Track]) -> dict[str, Callable]:
    """What is to be measured, with what only one part needs."""
    own = {"accuracy": {"everything": options.all}, "growth": {"tracks": tracks}}
    return {name: partial(PARTS[name].measure, **own.get(name, {})) for name in options.only}


def tell(message: str) -> None:
    LOUD.print(message, markup=False, highlight=False)


def show(found: Sequence[Claim], console: Console) -> None:
    """The claims as a table."""
    shown = Shown(box=None, pad_edge=False)
    for name in ("claim", "scene", "target", "measured", "95 % interval", "outcome"):
        shown.add_column(name, overflow="fold")
    for claim in found:
        shown.add_row(*page.cells(claim))
    console.print(shown)


if __name__ == "__main__":
    sys.exit(main())
