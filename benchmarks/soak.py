"""The long form of the tests of faults, kills and fuzzed inputs, with a table of what came of them.

    python benchmarks/soak.py --faults 1000 --kills 100 --inputs 100000
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from itertools import cycle, islice
from pathlib import Path

import pandas as pd
import psutil

TESTS = Path(__file__).resolve().parents[1] / "tests"
FLOOD = 1 << 30  # bytes that a renderer may print: the limit is what stops it
MORE_OUTSIDE = ("garbage", "exits", "crashes", "fails-after", "hangs", "closes-output", "floods", "floods-errors", "twice",
                "half-an-image", "no-file", "nan", "negative", "leaves-a-child")
HANGING = ("hangs", "hangs-before", "hangs-after", "answers-late")
SHORT, LONG = 0.7, 60.0  # s: for those that hang, and for those that do not


def main() -> None:
    options = arguments()
    sys.path.insert(0, str(TESTS))
    for soak, count in ((soak_faults, options.faults), (soak_kills, options.kills), (soak_inputs, options.inputs)):
        if count:
            before, start = usage(), time.monotonic()
            table = soak(count)
            print(f"\n{soak.__doc__}\n\n{table.to_string(index=False)}\n")
            print(f"{time.monotonic() - start:.0f} s; before: {before}; after: {usage()}", flush=True)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faults", type=int, default=1000, help="faulty trials (default: %(default)s)")
    parser.add_argument("--kills", type=int, default=100, help="kills of the harness (default: %(default)s)")
    parser.add_argument("--inputs", type=int, default=100_000, help="fuzzed inputs (default: %(default)s)")
    return parser.parse_args()


def usage() -> str:
    """What this process holds."""
    here = psutil.Process()
    memory = here.memory_info().rss / 1e6
    return f"{memory:.0f} MB, {here.num_fds()} open files, {len(here.children(recursive=True))} processes"


def soak_faults(count: int) -> pd.DataFrame:
    """Faulty trials: how each fault was recorded, how many of its trials were an error, and honest trials in between."""
    import test_faults as tests

    from lightproof.renderers.pool import Pool
    from lightproof.trial import Status

    rows: dict[str, dict] = {}
    with tempfile.TemporaryDirectory() as folder, Pool(threads=1, file_limit=FLOOD) as pool:
        for number, (kind, fault, render) in enumerate(islice(cycle(trials(tests, pool, Path(folder))), count)):
            result = render(number)
            honest = tests.is_right(tests.render(pool, Path(folder), replicate=number))
            row = rows.setdefault(f"{kind} {fault}", {"fault": f"{kind}: {fault}", "trials": 0, "errors": 0, "honest after": 0})
            row["trials"] += 1
            row["errors"] += result.status is Status.ERROR
            row["honest after"] += honest
            row["recorded as"] = result.message.replace(folder, "")[:150]
            if number % 100 == 0:
                print(f"{number} trials: {usage()}", flush=True)
    return pd.DataFrame(rows.values())


def trials(tests, pool, folder: Path) -> list[tuple[str, str, Callable]]:
    """Every fault in-process, then every fault of a program in both modes: (kind, name, a function of the trial's number)."""

    def inside(fault: str, timeout: float) -> Callable:
        return lambda number: tests.render(pool, folder, fault, number, timeout)

    def outside(fault: str, mode: str, timeout: float) -> Callable:
        return lambda number: tests.render_outside(pool, folder, fault, mode, number, timeout)

    faults = [("in-process", fault, inside(fault, LONG)) for fault in tests.FAULTS]
    faults += [("in-process", fault, inside(fault, SHORT)) for fault in tests.TIME_OUTS]
    faults += [("in-process", "leaves-a-child", inside("leaves-a-child", LONG))]
    for fault in (*tests.OUTSIDE, *MORE_OUTSIDE):
        timeout = SHORT if fault in HANGING else LONG
        faults += [(mode, fault, outside(fault, mode, timeout)) for mode in ("once", "lasting")]
    return faults


def soak_kills(count: int) -> pd.DataFrame:
    """Kills of the harness at random moments: how often runs were killed, and whether they ended like one left alone."""
    import test_kill as tests

    draw, rows = random.Random(0), []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        root = tests.make_suite(folder / "suite")
        seconds = tests.finish(root, folder / "alone")
        alone = tests.records(folder / "alone"), tests.films(folder / "alone")
        while sum(row["kills"] for row in rows) < count:
            out = folder / str(len(rows))
            kills = tests.kill(root, out, (draw.uniform(0, seconds) for _ in range(min(10, count))))
            tests.finish(root, out)
            same = (tests.records(out), tests.films(out)) == alone
            rows.append({"run": len(rows), "kills": kills, "trials": len(alone[0]), "records and films as if left alone": same})
            print(rows[-1], flush=True)
    return pd.DataFrame(rows)


def soak_inputs(count: int) -> pd.DataFrame:
    """Fuzzed inputs: how many each reader took and refused; any other error would have ended this."""
    import test_fuzz as tests

    each = -(-count // len(tests.READERS))
    return pd.DataFrame([{"reader": name, **counted(tests.fuzz, reader, each)} for name, reader in tests.READERS.items()])


def counted(fuzz: Callable, reader: object, examples: int) -> dict[str, object]:
    start = time.monotonic()
    counts = Counter(fuzz(reader, examples))
    seconds = round(time.monotonic() - start)
    return {"inputs": sum(counts.values()), **counts, "seconds": seconds, "memory": usage()}


if __name__ == "__main__":
    main()
