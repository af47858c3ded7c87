"""try each renderer, and say how to install what is missing; hold a renderer of your own to the protocol"""

from __future__ import annotations

import argparse

import numpy as np
from rich.console import Console
from rich.markup import escape

from lightproof import conformance, machine, suite
from lightproof.cli import selection
from lightproof.cli.status import DONE, INCOMPLETE
from lightproof.references import ReferenceError
from lightproof.renderers.doctor import SAMPLES, Examination, examine
from lightproof.renderers.registry import Entry
from lightproof.trial import Status

TRIAL_SCENES = ("square-light", "point-light", "sphere-furnace")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which methods."""
    parser.add_argument("methods", nargs="*", metavar="METHOD",
                        help="name, glob, module:name, file.py:name, or the manifest of a renderer of your own"
                             " (default: each renderer in its best configuration)")


def run(options: argparse.Namespace) -> int:
    """One line for each method, several for a manifest; 3 where one that is installed does not render, or a check fails."""
    console, home = Console(emoji=False, highlight=False, soft_wrap=True), suite.default()
    fine = []
    for entry in selection.methods(options.methods, tags=[]):
        with console.status(f"{escape(entry.name)}: compiling and rendering"):
            fine.append(_conforms(entry, home, console) if conformance.applies(entry) else _renders(entry, home, console))
    return DONE if all(fine) else INCOMPLETE


def _conforms(entry: Entry, home: suite.Suite, console: Console) -> bool:
    """One line for each check of the protocol; whether all are passed."""
    console.print(f"[bold]{escape(entry.name)}[/]")
    fine = True
    for check in conformance.examine(entry, home, machine.usable_cores()):
        fine &= check.passed
        console.print(f"  {'[green]pass[/]' if check.passed else '[red]FAIL[/]'}  {escape(f'{check.name}: {check.reason}')}")
    return fine


def _renders(entry: Entry, home: suite.Suite, console: Console) -> bool:
    """One line; whether the method renders, or is not there."""
    examination = examine(entry, [home.scene(name) for name in TRIAL_SCENES], machine.usable_cores())
    found = f"{examination.version or 'is not there'}: {_finding(examination, home)}"
    console.print(f"[bold]{escape(entry.name)}[/] {escape(found)}")
    return examination.result is None or examination.result.status is not Status.ERROR


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
