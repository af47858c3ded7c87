"""How far the items of a `World` reach along directions, all of them at once, and which lie in front of a plane."""

from __future__ import annotations

import numpy as np

from lightproof.estimators.shapes import Parallelogram, Triangle
from lightproof.estimators.world import CENTER, KIND, KINDS, NORMAL, RADIUS, U, V

CONTACT = 1e-12  # of a distance: what lies no farther in front of a plane than this coincides with it


def extents(items: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest coordinate (m, k) of items (m, WIDTH) along `directions` (3, k), unit vectors [m]; of a cap's whole
    sphere."""
    middle, a, b = items[:, CENTER:U] @ directions, items[:, U:V] @ directions, items[:, V:NORMAL] @ directions
    kind = items[:, KIND, None]
    triangle = kind == KINDS[Triangle]
    reach = np.where(kind == KINDS[Parallelogram], (abs(a) + abs(b)) / 2, np.hypot(a, b) + items[:, RADIUS, None])
    low = np.where(triangle, np.minimum(0, np.minimum(a, b)), -reach)
    high = np.where(triangle, np.maximum(0, np.maximum(a, b)), reach)
    return middle + low, middle + high


def reaching(items: np.ndarray, point: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Whether any of each item (m,) lies in front of the plane through a point with a unit normal."""
    level = float(point @ normal)
    high = extents(items, normal[:, None])[1][:, 0]
    return high - level > CONTACT * (abs(level) + np.abs(items[:, CENTER:U]).max(axis=1))
