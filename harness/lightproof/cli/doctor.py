"""try each renderer, and say how to install what is missing"""

from __future__ import annotations

import argparse

import numpy as np
from rich.console import Console
from rich.markup import escape

from lightproof import machine, suite
from lightproof.cli import selection
from lightproof.cli.status import DONE, INCOMPLETE
from lightproof.references import ReferenceError
from lightproof.renderers.doctor import SAMPLES, Examination, examine
from lightproof.trial import Status

TRIAL_SCENES = ("square-light", "point-light", "sphere-furnace")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which methods."""
    parser.add_argument("methods", nargs="*", metavar="METHOD", help="name, glob, module:Class or file.py:Class (default: all)")


def run(options: argparse.Namespace) -> int:
    """One line for each method; 3 where one that is installed does not render."""
    console, home = Console(emoji=False, highlight=False, soft_wrap=True), suite.default()
    scenes = [home.scene(name) for name in TRIAL_SCENES]
    broken = False
    for entry in selection.methods(options.methods, tags=[selection.NIGHTLY]):
        examination = examine(entry, scenes, machine.usable_cores())
        found = f"{examination.version or 'is not there'}: {_finding(examination, home)}"
        console.print(f"[bold]{escape(entry.name)}[/] {escape(found)}")
        broken |= examination.result is not None and examination.result.status is Status.ERROR
    return INCOMPLETE if broken else DONE


def _finding(examination: Examination, home: suite.Suite) -> str:
    """What a trial render says, in plain words."""
    scene, result = examination.scene, examination.result
    if result is None or result.film is None:
        return examination.message
    mean, quantity = np.mean(result.film), scene.film.quantity
    found = f"rendered {scene.id} at {SAMPLES} samples in {result.seconds['render']:.2g} s, mean {quantity} {mean:.4g}"
    try:
        return f"{found}, exact {np.mean(home.reference(scene).value):.4g}"
    except ReferenceError:
        return f"{found}, no exact light to compare with"
