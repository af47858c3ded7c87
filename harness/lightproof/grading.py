"""Somebody's pictures as results that can be judged: sizes, quantities and headers, but no exact light.

One picture says nothing of its noise. It is taken as it is, noise included, as a film of a method without noise would be:
it passes where each of its elements is right, and can fail only with a second one of four times the samples. Several
pictures that differ in nothing but their seed tell their noise, and are judged by intervals as any renderer's are.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from lightproof import exporting, films
from lightproof.films import FilmError
from lightproof.radiometry import QUANTITIES
from lightproof.renderers import views
from lightproof.scene import PointsFilm, Scene
from lightproof.suite import Suite
from lightproof.trial import Result, Status, Trial

METHOD = "picture"
PROGRAM = ("method_version", "software", "Software")  # attributes that name it
ALONE = "A single picture is judged as it is, noise included"
GREY = 1e-5  # of a picture's mean: channels that lie no farther apart are equal but for rounding
COUNT = re.compile("[1-9][0-9]{0,17}")  # in a header that may say anything


@dataclass(frozen=True)
class Reading:
    """How pictures are read: `quantity` is what they hold where that is not the film's own, `factor` brings them to SI units,
    `channel` names the channel or layer that holds the light, where it must be named; `samples` per pixel are those of the
    first step, where that is known and no header says it."""

    quantity: str = ""
    factor: float = 1.0
    channel: str = ""
    samples: int | None = None


def scene_of(path: Path, home: Suite) -> Scene:
    """The scene that the header of one of Lightproof's own films names. Raises FilmError, SceneError."""
    *_, header = films.read(path)
    if "scene" not in header or "digest" not in header:
        raise FilmError(f"{path}: does not say which scene it is of; say it with --scene")
    return home.scene(f"{header['scene']}:{header.get('case', '')}")


def results(steps: Sequence[Sequence[Path]], scene: Scene, reading: Reading) -> list[Result]:
    """The results of pictures of `scene`; those of every step have four times the samples of the step before, unless their
    headers say how many they have. Raises FilmError on a picture that cannot be read or does not fit, CannotExport where the
    scene's film is no picture."""
    read = [_result(path, scene, reading, 4**number) for number, paths in enumerate(steps) for path in paths]
    counts = Counter(result.samples for result in read)
    return [_replicate(result, number, counts[result.samples] == 1) for number, result in enumerate(read)]


def counted(results: Sequence[Result], reading: Reading) -> bool:
    """Whether it is known how many samples went into the pictures."""
    return reading.samples is not None or all("samples" in result.settings for result in results)


def header(scene: Scene) -> dict[str, str]:
    """What the header of a picture's film says."""
    return {"scene": scene.id, "case": scene.case, "digest": scene.digest, "quantity": scene.film.quantity,
            "unit": QUANTITIES[scene.film.quantity].unit, "method": METHOD}


def _replicate(result: Result, number: int, alone: bool) -> Result:
    notes = [ALONE, result.caveat] if alone else [result.caveat]
    trial = replace(result.trial, replicate=number)
    return replace(result, trial=trial, deterministic=alone, caveat=". ".join(filter(None, notes)))


def _result(path: Path, scene: Scene, reading: Reading, multiple: int) -> Result:
    grid, channels, header = films.read(path, reading.channel)
    _check_header(path, header, scene, reading)
    half, known = channels.get("quantization"), COUNT.fullmatch(header.get("samples", ""))
    if half is not None and not (half >= 0).all():
        raise FilmError(f"{path}: its channel quantization holds what is no half step; each value must be zero or more")
    samples = (int(header["samples"]) if known else multiple * (reading.samples or 1)) * _block(grid, scene) ** 2
    about = {"file": str(path), "quantity": reading.quantity or scene.film.quantity, "factor": reading.factor}
    return Result(
        Trial(scene.id, scene.case, scene.digest, METHOD, samples, 0), Status.OK,
        film=_elements(path, channels["Y"].reshape(grid), scene, reading),
        quantization=0.0 if half is None else _elements(path, half.reshape(grid), scene, reading),
        samples=samples,
        version=next((header[key] for key in PROGRAM if key in header), ""),
        settings=about | ({"samples": samples} if known else {}),
        precision="float32" if half is None else "",
        caveat=". ".join(_caveats(channels)),
    )


def _caveats(channels: Mapping[str, np.ndarray]) -> Iterator[str]:
    apart = np.mean(channels.get("spread", 0.0)) / (np.mean(channels["Y"]) or 1.0)
    if apart > GREY:
        yield (f"R, G and B lie {100 * apart:.2g} % apart, on average, though every scene is grey; what is judged is their mean"
               " (--channel judges one)")
    if "quantization" in channels:
        yield "Its format rounds, and half a step of it widens each interval"


def _check_header(path: Path, header: Mapping[str, str], scene: Scene, reading: Reading) -> None:
    """Raise FilmError where one of Lightproof's own films is of something else."""
    if header.get("digest", scene.digest) != scene.digest:
        raise FilmError(f"{path}: its header says that it is of another scene, or another version of it:"
                        f" {header.get('scene')!a}, digest {header['digest'][:12]!a}; {scene.name} has {scene.digest[:12]}")
    if "digest" in header and reading.quantity and header.get("quantity") != reading.quantity:
        raise FilmError(f"{path}: its header says that it holds {header.get('quantity')!a}, not {reading.quantity}")


def _elements(path: Path, picture: np.ndarray, scene: Scene, reading: Reading) -> np.ndarray:
    """Film elements (n,) in the film's unit: means over blocks where the picture is finer."""
    quantity = reading.quantity or scene.film.quantity
    if quantity == scene.film.quantity:
        return reading.factor * _fitted(path, picture, scene).ravel()
    if (quantity, scene.film.quantity) != ("radiance", "irradiance"):
        raise FilmError(f"{path}: {scene.name} is a film of {scene.film.quantity}; it cannot be told from {quantity}")
    return reading.factor * exporting.view(scene).elements(_fitted(path, picture, scene))


def _block(grid: tuple[int, int], scene: Scene) -> int:
    """Pixels along each side of an element."""
    return 1 if isinstance(scene.film, PointsFilm) else max(1, grid[0] // scene.film.grid[0])


def _fitted(path: Path, picture: np.ndarray, scene: Scene) -> np.ndarray:
    rows, columns = scene.film.grid
    block = _block(picture.shape, scene)
    if picture.shape != (rows * block, columns * block):
        has = f"{picture.shape[1]} x {picture.shape[0]}"
        raise FilmError(f"{path}: is {has} pixels; {scene.name} takes {columns} x {rows}, or for a mean whole multiples of it")
    return views.pooled(picture, block)
