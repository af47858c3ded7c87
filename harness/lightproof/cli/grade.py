"""judge pictures that any renderer made against the exact light, and make their page"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.markup import escape

from lightproof import diagnose, films, grading, machine, plan, store, suite
from lightproof.cli import selection
from lightproof.cli.run import count, exit_status, positive
from lightproof.cli.status import INCOMPLETE
from lightproof.exporting import CannotExport
from lightproof.grading import METHOD, Reading
from lightproof.judging import Judge, homes
from lightproof.runner import REPLICATES
from lightproof.scene import Scene
from lightproof.store import Store
from lightproof.suite import Suite
from lightproof.trial import Result
from lightproof.verdict import Outcome, Verdict

GRADES = Path("reports/grades")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which pictures, of what."""
    add = parser.add_argument
    add("images", nargs="+", type=Path, metavar="IMAGE", help="an OpenEXR picture, or several that differ in the seed alone")
    add("--finer", nargs="+", type=Path, default=[], metavar="IMAGE",
        help="more of them, at four times the samples: nothing fails without")
    add("--scene", metavar="SCENE", help="id, id:case or path of a .toml file (default: what the picture's header says)")
    add("--quantity", choices=("irradiance", "radiance", "solid_angle"), default="",
        help="what a pixel holds; radiance for a picture of an exported receiver (default: what the scene's film is of)")
    add("--scale", type=positive("number"), default=1.0, metavar="FACTOR",
        help="pixel values times this are in SI units (default: 1)")
    add("--channel", default="", metavar="NAME", help="a channel or layer (default: Y, or the mean of R, G and B)")
    add("--samples", type=count(1), metavar="N", help="per pixel, where that is known")
    add("--out", type=Path, default=GRADES, metavar="DIR", help="where a folder for the page is made (default: %(default)s)")
    add("--suite", type=Path, metavar="DIR", help="a folder with scenes/ and references/ (default: Lightproof's own)")
    add("--strict", action="store_true", help="exit 1 where the verdict is fail, 3 where it is undecided")


def run(options: argparse.Namespace) -> int:
    """Record the pictures as a run of one method, print the verdict and the path of the page."""
    home = Suite(options.suite) if options.suite else suite.default()
    scene, home = _scene(options, home)
    reading = Reading(options.quantity, options.scale, options.channel, options.samples)
    try:
        results = grading.results([options.images, options.finer], scene, reading)
    except CannotExport as reason:
        print(f"lightproof grade: {scene.name} has no picture of radiance: {reason}", file=sys.stderr)
        return INCOMPLETE
    store.check_writable(options.out)
    record = _record(options.out, results, scene, home, grading.counted(results, reading))
    judge = Judge(record)
    verdict = judge.judge(results)
    unsaid = bool(options.scene and not options.quantity)
    _tell(verdict, _doubts(verdict, results, scene, judge, unsaid), scene, record)
    return exit_status([verdict.outcome], options.strict, complete=True)


def _scene(options: argparse.Namespace, home: Suite) -> tuple[Scene, Suite]:
    if options.scene is None:
        return grading.scene_of(options.images[0], home), home
    return next(iter(selection.scenes([options.scene], [], home).items()))


def _record(out: Path, results: Sequence[Result], scene: Scene, home: Suite, counted: bool) -> Store:
    versions = {METHOD: results[0].version or "of unknown origin"}
    run = plan.describe({scene: home}, [], machine.usable_cores(), 0, versions, counted=counted)
    record = store.create(out, run, [scene])
    for result in results:
        path = record.film_path(result.trial)
        path.parent.mkdir(parents=True, exist_ok=True)
        channels = {"Y": result.film} | ({"quantization": result.quantization} if np.any(result.quantization) else {})
        films.write(path, scene.film.grid, channels, grading.header(scene))
        record.append(result)
    record.sync()
    return record


def _doubts(verdict: Verdict, results: Sequence[Result], scene: Scene, judge: Judge, unsaid: bool) -> Iterator[str]:
    """What is likely wrong with pictures that are too few to fail, or with how they were read; `unsaid`: nobody says what
    quantity they hold."""
    yield results[0].caveat
    if verdict.outcome is Outcome.UNDECIDED and 1 < len(results) < REPLICATES:
        yield f"The fewer pictures, the wider the intervals: {len(results)} are few, {REPLICATES} are what the rule is made for"
    reference = judge.reference(results)
    if verdict.outcome is Outcome.UNDECIDED and reference is not None:
        film = np.mean([result.film for result in results], axis=0)
        mistake = diagnose.diagnose(film, np.zeros(scene.size), reference.value, scene) or ""
        yield mistake[:1].upper() + mistake[1:]
    if verdict.outcome is not Outcome.PASS and scene.film.quantity == "irradiance" and unsaid:
        yield "It was read as irradiance; of a picture of an exported receiver say --quantity radiance"


def _tell(verdict: Verdict, doubts: Iterator[str], scene: Scene, record: Store) -> None:
    from lightproof import reporting  # pandas and altair take a second that an error need not wait for

    page = reporting.write(record.folder, homes(record))
    console = Console(emoji=False, highlight=False, soft_wrap=True)
    reason = ". ".join(filter(None, (verdict.reason, *doubts)))
    console.print(f"{escape(scene.name)}: [bold]{verdict.outcome}[/]: {escape(reason)}")
    console.print(escape(str(page)))
