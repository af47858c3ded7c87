"""A few films against the exact light, in plain words: the first look at a renderer, long before a verdict."""

from __future__ import annotations

import numpy as np

from lightproof import diagnose, statistics
from lightproof.scene import Scene

UNITS, PATTERN = 0.02, 0.05  # of the light: how far a factor may be from 1, and a film from its factor times the exact light
NOISE = 3  # standard errors allowed on top

HINTS = {
    "0, the film is black": "does any light reach the film?",
    "pi": "is the division by pi missing?",
    "1/pi": "is it divided by pi once too often?",
    "4/pi": "is a disk or a hemisphere taken for a square?",
    "pi/4": "is a square taken for a disk or a hemisphere?",
    "2": "is light counted twice, or on both sides of a light?",
    "1/2": "is only half of the light or of the directions sampled?",
    "2 pi": "is the division by 2 pi, the density over a hemisphere, missing?",
    "1/(2 pi)": "is it divided by 2 pi once too often?",
    "4 pi": "is the division by 4 pi missing, or intensity taken for power?",
    "1/(4 pi)": "is it divided by 4 pi once too often, or power taken for intensity?",
    "179 (Radiance's lumens per watt)": "are these Radiance's lumens, 179 per watt?",
    "683 (lumens per watt at 555 nm)": "are these lumens, 683 per watt?",
}


def compare(films: np.ndarray, value: np.ndarray, scene: Scene) -> tuple[bool, str]:
    """Whether films (R, n) are the light `value` (n,) but for noise, and what is wrong if not."""
    factors = films @ value / (value @ value)
    factor, error = float(factors.mean()), float(NOISE * factors.std(ddof=1) / np.sqrt(len(factors)))
    if error > PATTERN:
        return False, f"too noisy: the factor is {factor:.3g} ± {error:.2g} and is to be 1"
    if abs(factor - 1) > UNITS + error:
        return False, _factor(factor, error)
    film, noise = films.mean(axis=0), statistics.standard_error(films)
    if _rms(film - factor * value) > PATTERN * _rms(value) + NOISE * _rms(noise):
        mistake = diagnose.diagnose(film, noise, value, scene) or "the light is in the wrong places"
        return False, f"the mean is right, the film is not: {mistake}"
    return True, f"mean {film.mean():.4g}, exact {value.mean():.4g}"


def _factor(factor: float, error: float) -> str:
    """What is wrong with a film that is the exact light times a factor, known to `error`."""
    near = {name: constant for name, constant in diagnose.FACTORS.items() if abs(factor - constant) <= UNITS * constant + error}
    if len(near) != 1:
        return _off(factor)
    ((name, constant),) = near.items()
    return f"{_off(constant)}: {HINTS.get(name, f'is it a factor of {name}?')}"


def _off(factor: float) -> str:
    return f"{factor:.3g} times too bright" if factor > 1 else f"{1 / factor:.3g} times too dark" if factor > 0 else "black"


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
