"""compute the exact light of scenes with two engines, and keep it where they agree"""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from concurrent.futures import Future, ProcessPoolExecutor, wait
from multiprocessing import Manager
from pathlib import Path
from queue import Queue

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TimeRemainingColumn

from lightproof import machine, scene_file, suite
from lightproof.certify import admission
from lightproof.certify.admission import Admitted
from lightproof.certify.balls import CannotCertify
from lightproof.cli.checkup import checkup
from lightproof.cli.run import count
from lightproof.cli.status import DONE, FAILED, INCOMPLETE, UsageError, unknown
from lightproof.scene import Scene
from lightproof.suite import Suite

Cases = dict[str, Scene]
KINDS = {"enclosure": "a proven enclosure", "quadrature": "an estimate"}
LISTEN = 0.2  # s between looks at what the workers have done


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which scenes, and whether to write."""
    add = parser.add_argument
    add("scenes", nargs="*", metavar="SCENE", help="id, or path of a .toml file; every case of it")
    add("--all", action="store_true", help="every scene of the suite")
    add("--suite", type=Path, metavar="DIR", help="a folder with scenes/ (default: Lightproof's own)")
    add("--check", action="store_true",
        help="write nothing; exit 1 where a stored reference does not fit its scene, or a random element of it is another")
    add("--seed", type=count(0), metavar="N", help="of the elements that --check draws (default: another each time)")


def run(options: argparse.Namespace) -> int:
    """Certify and write, 3 where a scene could not be certified; or check, 1 where something is wrong."""
    home = Suite(options.suite) if options.suite else suite.default()
    names = options.scenes or (home.ids if options.all or options.check else ())
    if not names:
        raise UsageError("there is nothing to certify; name a scene, the path of a scene file, or --all")
    chosen = [_cases(name, home) for name in names]
    console = Console(emoji=False, highlight=False, soft_wrap=True)
    return _check(chosen, options.seed, console) if options.check else _certify(chosen, console)


def _cases(name: str, home: Suite) -> tuple[Cases, Suite]:
    """Every case of a scene, and the suite that its reference belongs to."""
    if name.endswith(".toml"):
        return scene_file.read_cases(Path(name)), Suite(Path(name).resolve().parent.parent)
    if name not in home.ids:
        raise unknown("scene", name, home.ids)
    return home.cases(name), home


def _check(chosen: Iterable[tuple[Cases, Suite]], seed: int | None, console: Console) -> int:
    found = checkup(((scene, home) for cases, home in chosen for scene in cases.values()), seed)
    for complaint in found.complaints:
        console.print(complaint, markup=False)
    console.print(found.summary)
    return FAILED if found.complaints else DONE


def _certify(chosen: list[tuple[Cases, Suite]], console: Console) -> int:
    """Admit case by case on all cores; a scene is written as soon as all its cases are admitted."""
    with Manager() as manager, ProcessPoolExecutor(machine.usable_cores()) as pool, _bar(console) as bar:
        ticks = manager.Queue()
        work = [({case: pool.submit(_admit, scene, home, ticks) for case, scene in cases.items()}, home)
                for cases, home in chosen]
        task = bar.add_task("", total=sum(scene.size for cases, _ in chosen for scene in cases.values()))
        statuses = []
        for futures, home in work:
            while wait(futures.values(), timeout=LISTEN).not_done:
                bar.advance(task, _drained(ticks))
            statuses.append(_finished(futures, home, console))
    return max(statuses)


def _bar(console: Console) -> Progress:
    columns = BarColumn(), TaskProgressColumn(), TimeRemainingColumn()
    return Progress(*columns, console=console, transient=True, disable=not console.is_terminal)


def _admit(scene: Scene, home: Suite, ticks: Queue) -> Admitted:
    return admission.admit(scene, home.root / "references", lambda: ticks.put(None))


def _drained(ticks: Queue) -> int:
    """How many elements were finished since the last look."""
    count = 0
    while not ticks.empty():
        ticks.get()
        count += 1
    return count


def _finished(futures: dict[str, Future[Admitted]], home: Suite, console: Console) -> int:
    """Write one scene, or say which of its cases has no answer."""
    refusals = [reason for future in futures.values() if isinstance(reason := future.exception(), CannotCertify)]
    for reason in refusals:
        console.print(f"not certified: {reason}", markup=False)
    return INCOMPLETE if refusals else _write({case: future.result() for case, future in futures.items()}, home, console)


def _write(cases: dict[str, Admitted], home: Suite, console: Console) -> int:
    folder = home.root / "references"
    try:
        admission.write(folder, cases)
    except OSError as error:
        raise UsageError(f"{folder}: cannot be written ({error.strerror}); give a suite that can, with --suite") from None
    for admitted in cases.values():
        console.print(f"{admitted.scene.name}: {_engines(admitted)}; written to {folder}", markup=False)
    return DONE


def _engines(admitted: Admitted) -> str:
    proven = f"{admitted.certified.engine} within {admitted.uncertainty.max() / admitted.scale:.1e} of the largest value"
    if admitted.second_engine == "none":
        return f"{proven}, by {KINDS[admitted.certified.kind]} alone"
    return f"{proven}, {admitted.second_engine} agrees to {admitted.agreement:.1e} on {admitted.checked} of {admitted.scene.size}"
