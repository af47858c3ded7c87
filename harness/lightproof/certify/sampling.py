"""Which elements of a film the second engine computes: all, or of shadow means enough of every kind."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lightproof.certify.engine import certify
from lightproof.scene import PlaneFilm, Scene

EACH = 32  # elements of every kind
DARK = 1e-15  # of the film's largest value
SAME = 1e-12  # relative


def chosen(scene: Scene, value: np.ndarray, shadowed: bool) -> list[int]:
    """Elements of a film `value` (n,): every one, but where `shadowed` those that `kinds` tells apart, EACH of each kind."""
    if not shadowed or not isinstance(scene.film, PlaneFilm):
        return list(range(scene.size))
    names = kinds(scene, value)
    return sorted(int(element) for name in np.unique(names) for element in _spread(np.flatnonzero(names == name)))


def kinds(scene: Scene, value: np.ndarray) -> np.ndarray:
    """(n,) What the blockers do to each element: "lit" (nothing), "umbra" (all), "split" (a shadow's edge is near: partly shaded,
    beside one of the other kinds) or "penumbra" (partly shaded all round)."""
    without = certify(replace(scene, surfaces=()))
    umbra = value <= DARK * value.max()
    lit = ~umbra & (np.abs(value - without.value) <= SAME * np.abs(without.value))
    partly = ~umbra & ~lit
    edge = partly & _beside(umbra | lit, scene.film.grid)
    return np.select([umbra, lit, edge], ["umbra", "lit", "split"], "penumbra")


def _beside(marked: np.ndarray, grid: tuple[int, int]) -> np.ndarray:
    """(n,) Whether any of the up to eight elements around each is marked."""
    padded = np.pad(marked.reshape(grid), 1)
    rows, columns = grid
    shifts = [padded[i:i + rows, j:j + columns] for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    return np.any(shifts, axis=0).ravel()


def _spread(elements: np.ndarray) -> np.ndarray:
    """EACH of some elements, evenly spread; all where there are no more."""
    return elements[np.unique(np.linspace(0, len(elements) - 1, EACH).round().astype(int))]
