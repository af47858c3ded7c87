"""Film elements as rows of numbers: where a receiver point lies and which way it faces."""

from __future__ import annotations

import numpy as np

from lightproof import geometry
from lightproof.scene import PlaneFilm, PointsFilm

CENTER, NORMAL, CELL = slice(0, 3), slice(9, 12), slice(12, 15)


def receivers(film: PlaneFilm | PointsFilm) -> np.ndarray:
    """(n, 15): centre; frame (t, b, normal), t along u; and a, b, c such that the cell is centre + (a p + b q) t + c q b
    for p, q in [-1/2, 1/2]. A point is a cell without extent."""
    return of_plane(film) if isinstance(film, PlaneFilm) else of_points(film)


def of_plane(film: PlaneFilm) -> np.ndarray:
    rows, columns = film.grid
    u, v = np.array(film.u) / columns, np.array(film.v) / rows
    frame = [geometry.unit(u), np.cross(film.normal, geometry.unit(u)), film.normal]
    row, column = np.divmod(np.arange(rows * columns), columns)
    centers = np.array(film.origin) + (column + 0.5)[:, None] * u + (row + 0.5)[:, None] * v
    cell = [np.linalg.norm(u), v @ frame[0], v @ frame[1]]
    return np.hstack([centers, np.tile(np.concatenate([*frame, cell]), (len(centers), 1))])


def of_points(film: PointsFilm) -> np.ndarray:
    frames = [np.concatenate([*geometry.tangents(np.array(normal)), geometry.unit(np.array(normal))]) for normal in film.normals]
    return np.hstack([np.array(film.positions), np.array(frames), np.zeros((len(frames), 3))])


def flat(receivers: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """A point and the normal of the plane that all receivers lie in; None where they do not lie in one."""
    normal, point = receivers[0, NORMAL], receivers[0, CENTER]
    level = np.abs((receivers[:, CENTER] - point) @ normal).max() == 0 and (receivers[:, NORMAL] == normal).all()
    return (point, normal) if level else None
