"""A renderer in a few lines: a function (scene, samples, seed) -> film, run like any other method.

The film is an array (n,), row by row, or (rows, columns), or a `Rendering` that also says what it knows of its noise. A
function that cannot do a scene raises NotImplementedError with the reason, which makes the scene `unsupported`.
"""

from __future__ import annotations

import hashlib
import inspect
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from lightproof.films import FilmError
from lightproof.method import Method, Rendering
from lightproof.scene import Scene


def as_method(target: Any, name: str, threads: int) -> Method:
    """The method `name` of what its target holds: a subclass of Method, or a function. Raises TypeError on anything else."""
    if inspect.isclass(target) and issubclass(target, Method):
        return target(name, threads)
    if callable(target) and not inspect.isclass(target):
        return Function(target, name, threads)
    raise TypeError(f"{target!r:.60} is no renderer; give a function (scene, samples, seed) -> film, or a subclass of"
                    " lightproof.method.Method")


class Function(Method):
    """A function as a method; nothing is known of how it samples, so that a black tile may be bad luck."""

    samples_lights = False
    precision = "float64"

    def __init__(self, function: Callable[[Scene, int, int], Any], name: str, threads: int):
        super().__init__(name, threads)
        self._function = function

    def open(self) -> None:
        """Raises TypeError where the function takes other arguments."""
        try:
            signature = inspect.signature(self._function)
        except ValueError:  # compiled functions have none
            return
        try:
            signature.bind("scene", 1, 1)
        except TypeError as error:
            raise TypeError(f"the function takes {signature}, but is called with (scene, samples, seed): {error}") from None

    def version(self) -> str:
        """The `__version__` of its module, else the first digits of the SHA-256 of the module's file."""
        module = sys.modules[self._function.__module__]
        if hasattr(module, "__version__"):
            return str(module.__version__)
        return f"sha256 {hashlib.sha256(Path(module.__file__).read_bytes()).hexdigest()[:12]}"

    def unsupported(self, scene: Scene) -> None:
        """Told by the function itself, when it renders."""

    def prepare(self, scene: Scene) -> dict[str, float]:
        self._scene = scene
        return {}

    def render(self, samples: int, seed: int) -> Rendering:
        given = self._function(self._scene, samples, seed)
        rendering = given if isinstance(given, Rendering) else Rendering(given, samples)
        variance = rendering.variance
        return replace(rendering, film=flat(rendering.film, "film", self._scene),
                       variance=None if variance is None else flat(variance, "variance", self._scene))


def flat(values: Any, name: str, scene: Scene) -> np.ndarray:
    """The (n,) values of an array (n,) or (rows, columns). Raises FilmError on anything else."""
    fits = f"an array of shape ({scene.size},), row by row, or {scene.film.grid}"
    if values is None:
        raise FilmError(f"the {name} is None: does the function return it? It must be {fits}")
    try:
        array = np.asarray(values, float)
    except (TypeError, ValueError):
        raise FilmError(f"the {name} is {values!r:.60}, which holds no numbers; it must be {fits}") from None
    if array.shape not in ((scene.size,), scene.film.grid):
        raise FilmError(f"the {name} has shape {array.shape}; it must be {fits}")
    return array.ravel()
