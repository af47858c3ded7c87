"""Where Radiance is asked for light: rays to measure irradiance or radiance along, spread evenly over each film element."""

from __future__ import annotations

import math

import numpy as np

from lightproof import geometry
from lightproof.scene import CameraFilm, Film, PlaneFilm, PointsFilm

OFFSET = 1e-4  # m: rtrace measures irradiance this far above the point that it is given


def rays(film: Film, count: int, generator: np.random.Generator, scale: float) -> np.ndarray:
    """Origins and directions (elements x count, 6): for irradiance a point and the normal there, for radiance a line of sight.
    The `count` of an element, a product of `strata`, lie together; lengths times `scale`."""
    match film:
        case PlaneFilm():
            a, b = _positions(film.grid, count, generator)
            points = np.array(film.origin) + a * np.array(film.u) + b * np.array(film.v)
            return _above(scale * points, film.normal)
        case PointsFilm():
            points, normals = np.repeat(film.positions, count, axis=0), np.repeat(film.normals, count, axis=0)
            return _above(scale * points, geometry.unit(normals))
        case CameraFilm():
            lines = _sight(film, *_positions(film.grid, count, generator))
            return lines * np.repeat([scale, 1.0], 3)


def strata(count: int) -> tuple[int, int]:
    """Rows and columns of strata, as square as can be, that `count` places of an element fill or overfill."""
    rows = math.isqrt(count)
    return rows, math.ceil(count / rows)


def _positions(grid: tuple[int, int], count: int, generator: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Column and row coordinates (n, 1) over the film, in [0, 1], one in each stratum of each element; the strata of an element
    in random order, so that they keep no step with Radiance's own numbers."""
    (rows, columns), (down, across) = grid, strata(count)
    row, column = np.indices(grid).reshape(2, -1, 1)
    order = generator.permuted(np.tile(np.arange(down * across), (rows * columns, 1)), axis=1)
    jitter = generator.random((2, *order.shape))
    x, y = (column + (order % across + jitter[0]) / across) / columns, (row + (order // across + jitter[1]) / down) / rows
    return x.reshape(-1, 1), y.reshape(-1, 1)


def _above(points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    normals = np.broadcast_to(normals, points.shape)
    return np.hstack([points - OFFSET * normals, normals])


def _sight(film: CameraFilm, across: np.ndarray, down: np.ndarray) -> np.ndarray:
    right, up, forward = geometry.camera_frame(film.origin, film.target, film.up)
    half_width, half_height = film.half_extent
    aside = (2 * across - 1) * half_width * right + (1 - 2 * down) * half_height * up
    if film.projection == "perspective":
        return np.hstack([np.broadcast_to(film.origin, aside.shape), forward + aside])
    return np.hstack([np.array(film.origin) + aside, np.broadcast_to(forward, aside.shape)])
