"""Whether a round shape stands between two points."""

from __future__ import annotations

import numpy as np

from lightproof import geometry
from lightproof.geometry import Cylinder, Disk, Sphere


def hides(shape: Disk | Sphere | Cylinder, start: np.ndarray, end: np.ndarray) -> bool:
    """Whether the segment between two points (3,) crosses the shape."""
    way = end - start
    match shape:
        case Sphere():
            return bool(_roots(way, start - shape.center, shape.radius).size)
        case Disk():
            normal = geometry.unit(shape.normal)
            along = way @ normal
            part = (shape.center - start) @ normal / along if along else np.inf
            return bool(0 < part < 1 and np.linalg.norm(start + part * way - shape.center) <= shape.radius)
        case Cylinder():
            axis, offset = geometry.unit(shape.axis), start - shape.base
            parts = _roots(way - way @ axis * axis, offset - offset @ axis * axis, shape.radius)
            heights = (offset + parts[:, None] * way) @ axis
            return bool(((heights >= 0) & (heights <= shape.height)).any())


def _roots(way: np.ndarray, offset: np.ndarray, radius: float) -> np.ndarray:
    """Parts of the way, between 0 and 1, at which it is `radius` from the origin; `offset` is where it starts."""
    square, half = way @ way, way @ offset
    under = half**2 - square * (offset @ offset - radius**2)
    if under < 0 or square == 0:
        return np.empty(0)
    parts = (-half + np.array([-1, 1]) * np.sqrt(under)) / square
    return parts[(parts > 0) & (parts < 1)]
