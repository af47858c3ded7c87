"""Results and references made of arrays, for tests of what comes after rendering."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lightproof import suite
from lightproof.references import Reference
from lightproof.scene import Scene
from lightproof.trial import Result, Status, Trial

SCENE = suite.default().scene("square-light")  # 12 rows x 16 columns in 48 tiles of 2 x 2; tolerance 0.005 of the largest
LIGHT = np.linspace(2, 4, SCENE.size)  # stands for its exact light [W/m2]; the scale of errors is 4


def reference(value: np.ndarray = LIGHT, uncertainty: float = 1e-9, scene: Scene = SCENE) -> Reference:
    """Exact light (n,) with the same uncertainty everywhere."""
    return Reference(scene.id, scene.case, value, np.full(scene.size, uncertainty), "given", "given", 0.0, "", (), scene.digest)


def trial(samples: int, replicate: int = 0, scene: Scene = SCENE) -> Trial:
    return Trial(scene.id, scene.case, scene.digest, "given", samples, replicate)


def results(steps: Mapping[int, Sequence[np.ndarray]], scene: Scene = SCENE, **fields: Any) -> list[Result]:
    """A ladder of films: {samples: films (n,)}; `fields` go into every Result."""
    return [Result(trial(samples, replicate, scene), Status.OK, film=np.asarray(film, float), samples=samples, **fields)
            for samples, films in steps.items() for replicate, film in enumerate(films)]


def noisy(film: np.ndarray, spread: float, replicates: int = 16, seed: int = 1) -> np.ndarray:
    """Replicates (R, n) of a film, each element with a standard deviation of `spread` [W/m2]."""
    return film + spread * np.random.default_rng(seed).standard_normal((replicates, film.size))


def error(samples: int, message: str, replicate: int = 0) -> Result:
    return Result(trial(samples, replicate), Status.ERROR, message=message)
