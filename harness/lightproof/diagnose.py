"""Names the likely mistake behind a failing film. Certain or silent: a mistake is named where it turns the exact light into
the film as closely as noise and tolerance allow, where that is far from the exact light itself, and where at most one other
mistake in the tables does the same.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from lightproof import sketch
from lightproof.scene import Scene
from lightproof.sketch import Share

CLOSE = 0.2  # how far the film may lie from an explanation, as a part of how far the explanation lies from the exact light
SHARP = 0.01  # the widest relative interval of a factor that still gets a name
ELEMENTS = 1024  # as many are enough to compare with a sketch

FACTORS = {
    "0, the film is black": 0.0,
    "pi": np.pi,
    "1/pi": 1 / np.pi,
    "4/pi": 4 / np.pi,
    "pi/4": np.pi / 4,
    "2": 2.0,
    "1/2": 0.5,
    "4": 4.0,
    "1/4": 0.25,
    "2 pi": 2 * np.pi,
    "1/(2 pi)": 0.5 / np.pi,
    "4 pi": 4 * np.pi,
    "1/(4 pi)": 0.25 / np.pi,
    "pi squared": np.pi**2,
    "1/pi squared": np.pi**-2,
    "179 (Radiance's lumens per watt)": 179.0,
    "1/179 (Radiance's lumens per watt)": 1 / 179,
    "683 (lumens per watt at 555 nm)": 683.0,
    "1/683 (lumens per watt at 555 nm)": 1 / 683,
}

ORIENTATIONS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "its rows run the wrong way": lambda image: image[::-1],
    "its columns run the wrong way": lambda image: image[:, ::-1],
    "it is turned by half a turn": lambda image: image[::-1, ::-1],
    "its rows and columns are exchanged": lambda image: image.T,
}

FORWARD, BACKWARD, ALL = slice(1, None), slice(None, -1), slice(None)
SHIFTS = {  # part of the film, and the part of the exact light that it shows

    "it is shifted by one row": ((FORWARD, ALL), (BACKWARD, ALL)),
    "it is shifted by one row, backwards": ((BACKWARD, ALL), (FORWARD, ALL)),
    "it is shifted by one column": ((ALL, FORWARD), (ALL, BACKWARD)),
    "it is shifted by one column, backwards": ((ALL, BACKWARD), (ALL, FORWARD)),
}

# What each mistake would make of a light's share at an element, from the cosine at the receiver, that at the light, and
# the squared distance [m2].
SHARES: dict[str, Share] = {
    "the receiver's cosine is missing": lambda receiver, light, square: (receiver > 0) * light / square,
    "the receiver's cosine counts twice": lambda receiver, light, square: receiver**2 * light / square,
    "the light's cosine is missing": lambda receiver, light, square: receiver * (light > 0) / square,
    "the light's cosine counts twice": lambda receiver, light, square: receiver * light**2 / square,
    "the distance is missing": lambda receiver, light, square: receiver * light,
    "the distance counts once, not squared": lambda receiver, light, square: receiver * light / np.sqrt(square),
}


@dataclass(frozen=True)
class Evidence:
    """A film, its standard error, and the exact light: arrays of one shape."""

    film: np.ndarray
    standard_error: np.ndarray
    value: np.ndarray

    def __getitem__(self, part: Any) -> Evidence:
        return Evidence(self.film[part], self.standard_error[part], self.value[part])

    def supports(self, expected: np.ndarray, accuracy: float) -> bool:
        """Whether the film is `expected`, known to a relative `accuracy`, and far from being the exact light."""
        allowed = 2 * _rms(self.standard_error) + accuracy * _rms(expected)
        return _rms(self.film - expected) <= allowed <= CLOSE * _rms(expected - self.value)

    @property
    def factor(self) -> float:
        """The constant that brings the exact light closest to the film."""
        return float((self.film * self.value).sum() / (self.value**2).sum())

    @property
    def factor_error(self) -> float:
        """Four standard errors of the factor."""
        return float(4 * np.sqrt(((self.value * self.standard_error) ** 2).sum()) / (self.value**2).sum())


def diagnose(film: np.ndarray, standard_error: np.ndarray, value: np.ndarray, scene: Scene) -> str | None:
    """The mistake, or either of two, that explains a failing `film` (n,), known to `standard_error` (n,), where the exact
    light is `value` (n,); None where that is not certain."""
    evidence = Evidence(film, standard_error, value)
    mistakes = [*_factors(evidence, scene), *_arrangements(evidence, scene), *_sketches(evidence, scene)]
    mistakes = mistakes or [*_unnamed_factor(evidence, scene)]
    return f"likely mistake: {', or '.join(mistakes)}" if 1 <= len(mistakes) <= 2 else None


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt((values**2).mean()))


def _factors(evidence: Evidence, scene: Scene) -> Iterator[str]:
    if not evidence.value.any():
        return
    for name, constant in FACTORS.items():
        half = evidence.factor_error + scene.tolerance * constant
        near = abs(evidence.factor - constant) <= half <= SHARP * constant
        if near and evidence.supports(constant * evidence.value, scene.tolerance):
            yield f"a factor of {name}"


def _unnamed_factor(evidence: Evidence, scene: Scene) -> Iterator[str]:
    if not evidence.value.any():
        return
    factor, error = evidence.factor, evidence.factor_error
    if error <= SHARP * factor and evidence.supports(factor * evidence.value, scene.tolerance):
        yield f"a constant factor of {factor:.4g} ± {error:.1g}"


def _arrangements(evidence: Evidence, scene: Scene) -> Iterator[str]:
    """Elements in the wrong places."""
    image = Evidence(*(values.reshape(scene.film.grid) for values in (evidence.film, evidence.standard_error, evidence.value)))
    for mistake, turned in ORIENTATIONS.items():
        moved = turned(image.value)
        if moved.shape == image.value.shape and image.supports(moved, scene.tolerance):
            yield mistake
    for mistake, (shown, moved) in SHIFTS.items():
        if image.value[shown].size and image[shown].supports(image.value[moved], scene.tolerance):
            yield mistake


def _sketches(evidence: Evidence, scene: Scene) -> Iterator[str]:
    """Mistakes in the sum over the lights, where the lights are simple and all the light is direct."""
    if not sketch.can(scene):
        return
    some = np.arange(0, scene.size, -(-scene.size // ELEMENTS))
    films = sketch.irradiance(scene, some, {"right": sketch.share, **SHARES})
    right = films.pop("right")
    if scene.surfaces and evidence[some].supports(right, sketch.ACCURACY):
        yield "the shadows are missing"
    for mistake, film in films.items():
        expected = evidence.value[some] * np.divide(film, right, out=np.zeros_like(right), where=right > 0)
        if evidence[some].supports(expected, sketch.ACCURACY):
            yield mistake
