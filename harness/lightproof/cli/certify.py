"""compute the exact light of scenes with two engines, and keep it where they agree"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.progress import Progress

from lightproof import scene_file, suite
from lightproof.certify import admission
from lightproof.certify.admission import Admitted
from lightproof.certify.balls import CannotCertify
from lightproof.cli.status import DONE, FAILED, INCOMPLETE, UsageError, unknown
from lightproof.references import ReferenceError
from lightproof.scene import Scene
from lightproof.suite import Suite


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which scenes, and whether to write."""
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="id, or path of a .toml file; every case of it")
    parser.add_argument("--all", action="store_true", help="every scene of the suite")
    parser.add_argument("--suite", type=Path, metavar="DIR", help="a folder with scenes/ (default: Lightproof's own)")
    parser.add_argument("--check", action="store_true", help="write nothing; exit 1 where what is stored is not what comes out")


def run(options: argparse.Namespace) -> int:
    """Certify, then write or compare; 3 where a scene could not be certified, 1 where a check fails."""
    home = Suite(options.suite) if options.suite else suite.default()
    names = home.ids if options.all else options.scenes
    if not names:
        raise UsageError("there is nothing to certify; name a scene, the path of a scene file, or --all")
    chosen = [_cases(name, home) for name in names]
    console = Console(highlight=False, soft_wrap=True)
    finish = _check if options.check else _write
    statuses = [_certified(cases, home, finish, console) for cases, home in chosen]
    return next((status for status in (INCOMPLETE, FAILED) if status in statuses), DONE)


def _cases(name: str, home: Suite) -> tuple[dict[str, Scene], Suite]:
    """Every case of a scene, and the suite that its reference belongs to."""
    if name.endswith(".toml"):
        return scene_file.read_cases(Path(name)), Suite(Path(name).resolve().parent.parent)
    if name not in home.ids:
        raise unknown("scene", name, home.ids)
    return home.cases(name), home


def _certified(cases: dict[str, Scene], home: Suite, finish, console: Console) -> int:
    """Admit every case of one scene, then finish with them."""
    try:
        with Progress(console=console, transient=True, disable=not console.is_terminal) as bar:
            admitted = {case: _admit(scene, home, bar) for case, scene in cases.items()}
    except CannotCertify as reason:
        console.print(f"not certified: {reason}", markup=False)
        return INCOMPLETE
    return finish(admitted, home, console)


def _admit(scene: Scene, home: Suite, bar: Progress) -> Admitted:
    task = bar.add_task(scene.name, total=scene.size)
    try:
        return admission.admit(scene, home.root / "references", lambda: bar.advance(task))
    except CannotCertify as reason:
        raise CannotCertify(f"{scene.name}: {str(reason).removeprefix(f'{scene.name}: ')}") from None


def _write(cases: dict[str, Admitted], home: Suite, console: Console) -> int:
    folder = home.root / "references"
    try:
        admission.write(folder, cases)
    except OSError as error:
        raise UsageError(f"{folder}: cannot be written ({error.strerror}); give a suite that can, with --suite") from None
    for admitted in cases.values():
        console.print(f"{admitted.scene.name}: {_engines(admitted)}; written to {folder}", markup=False)
    return DONE


def _check(cases: dict[str, Admitted], home: Suite, console: Console) -> int:
    findings = {admitted.scene.name: _difference(admitted, home) for admitted in cases.values()}
    for name, finding in findings.items():
        console.print(f"{name}: {finding or 'as stored'}", markup=False)
    return FAILED if any(findings.values()) else DONE


def _difference(admitted: Admitted, home: Suite) -> str:
    """What is wrong with the stored reference of a case; empty where each value is within the uncertainties of the new one."""
    try:
        stored = home.reference(admitted.scene)
    except ReferenceError as error:
        return str(error)
    off = np.abs(stored.value - admitted.certified.value) - stored.uncertainty - admitted.uncertainty
    return f"{np.count_nonzero(off > 0)} of {off.size} values differ from those stored" if (off > 0).any() else ""


def _engines(admitted: Admitted) -> str:
    proven = f"{admitted.certified.engine} within {admitted.uncertainty.max() / admitted.scale:.1e} of the largest value"
    if admitted.second_engine == "none":
        return f"{proven}, by a proven enclosure alone"
    return f"{proven}, {admitted.second_engine} agrees to {admitted.agreement:.1e}"
