"""A renderer of rectangular lamps above a floor, with rectangular things in between: next-event estimation in NumPy."""

from __future__ import annotations

import numpy as np

AT_ONCE = 64
STEPS = 1.1673039782614187 ** -np.arange(1, 5)  # of Roberts' sequence, which fills four dimensions evenly


def render(scene, samples: int, seed: int) -> np.ndarray:
    """Irradiance (rows, columns) [W/m2]: the mean over `samples` pairs of a point of the cell and a point of the lamp."""
    if scene.film.quantity != "irradiance" or not hasattr(scene.film, "u") or scene.max_bounces:
        raise NotImplementedError("this renderer has floors under direct light only")
    lamps = [(light.radiance, *rectangle(light)) for light in scene.lights]
    blockers = [rectangle(surface) for surface in scene.surfaces]
    start = np.random.default_rng(seed).random((4, 1, *scene.film.grid))
    total = np.zeros(scene.film.grid)
    for numbers in np.split(np.arange(samples), range(AT_ONCE, samples, AT_ONCE)):
        places = (start + np.multiply.outer(STEPS, numbers)[..., None, None]) % 1
        total += sum(light(scene.film, lamp, blockers, places) for lamp in lamps)
    return total / samples


def rectangle(thing) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A corner and the two edges from it; edge x edge points to the front."""
    corners = np.array(getattr(getattr(thing, "shape", None), "vertices", ()))
    if len(corners) != 4 or not np.allclose(corners[0] + corners[2], corners[1] + corners[3]):
        raise NotImplementedError("this renderer has rectangles only")
    return corners[0], corners[1] - corners[0], corners[3] - corners[0]


def light(film, lamp, blockers, places: np.ndarray) -> np.ndarray:
    """Sum over samples of the irradiance (rows, columns) from one lamp; `places` (4, samples, rows, columns) on cell and lamp."""
    radiance, corner, along, across = lamp
    rows, columns = film.grid
    row, column = np.indices((rows, columns))
    s, t, a, b = places
    floor = np.array(film.origin) + ((column + s) / columns)[..., None] * film.u + ((row + t) / rows)[..., None] * film.v
    towards = corner + a[..., None] * along + b[..., None] * across - floor
    area = np.cross(along, across)
    cosines = np.maximum(towards @ film.normal, 0) * np.maximum(-towards @ area, 0)
    seen = ~np.any([hits(floor, towards, blocker) for blocker in blockers], axis=0) if blockers else 1.0
    return (radiance * cosines * seen / np.sum(towards**2, axis=-1) ** 2).sum(axis=0)


def hits(start: np.ndarray, towards: np.ndarray, blocker) -> np.ndarray:
    """Whether a rectangle lies between `start` (..., 3) and `start + towards`."""
    corner, along, across = blocker
    normal = np.cross(along, across)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (corner - start) @ normal / (towards @ normal)
        place = start + distance[..., None] * towards - corner
    inside = [(place @ edge > 0) & (place @ edge < edge @ edge) for edge in (along, across)]
    return (distance > 0) & (distance < 1) & inside[0] & inside[1]
