"""The plane of a film as curves are drawn on it: p and q run from -1/2 to 1/2 over the film. Rows of curves: see `cells`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lightproof.scene import PlaneFilm

EVERYWHERE = np.array([-np.inf, np.inf, -np.inf, np.inf])
NOISE = 1e-12  # of a curve's largest coefficient: what rounding leaves of one that is zero
SAME = 1e-10  # of the film: how near two curves are one
PROBES = np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1], [1, 1]], float)


@dataclass(frozen=True)
class Sheet:
    """`center`, `u` and `v` (3,) of the film, its unit `normal`, and the `grid` (rows, columns)."""

    center: np.ndarray
    u: np.ndarray
    v: np.ndarray
    normal: np.ndarray
    grid: tuple[int, int]

    @classmethod
    def of(cls, film: PlaneFilm) -> Sheet:
        u, v = np.array(film.u), np.array(film.v)
        return cls(np.array(film.origin) + u / 2 + v / 2, u, v, film.normal, film.grid)

    @property
    def cell(self) -> float:
        """Diagonal of an element [m]."""
        rows, columns = self.grid
        return float(np.linalg.norm(self.u / columns) + np.linalg.norm(self.v / rows))

    def height(self, points: np.ndarray) -> np.ndarray:
        """How far points (..., 3) lie above the plane [m]."""
        return (points - self.center) @ self.normal

    def places(self, points: np.ndarray) -> np.ndarray:
        """p, q (..., 2) below points (..., 3)."""
        return (points - self.center) @ np.linalg.pinv(np.stack([self.u, self.v], axis=1)).T

    def lines(self, normals: np.ndarray, points: np.ndarray, boxes: np.ndarray = EVERYWHERE) -> np.ndarray:
        """Where planes with `normals` (m, 3) through `points` (m, 3) meet the film: rows of curves; not those parallel to it."""
        lengths = np.linalg.norm(normals, axis=-1)
        rows = np.zeros((len(normals), 10))
        rows[:, 0] = np.einsum("ij,ij->i", normals, self.center - points)
        rows[:, 1], rows[:, 2] = normals @ self.u, normals @ self.v
        rows[:, 6:] = boxes
        steepest = lengths * max(np.linalg.norm(self.u), np.linalg.norm(self.v))
        return rows[np.abs(rows[:, 1:3]).max(axis=1, initial=0) > NOISE * steepest]

    def conics(self, f: Callable[[np.ndarray], np.ndarray], boxes: np.ndarray = EVERYWHERE) -> np.ndarray:
        """Where quadratic functions are zero on the film: f maps points (6, 3) to values (m, 6)."""
        o, e, w, n, s, ne = f(self.center + PROBES[:, :1] * self.u + PROBES[:, 1:] * self.v).T
        c3, c5 = (e + w) / 2 - o, (n + s) / 2 - o
        c1, c2 = (e - w) / 2, (n - s) / 2
        rows = np.stack([o, c1, c2, c3, ne - o - c1 - c2 - c3 - c5, c5], axis=1)
        return np.hstack([rows, np.broadcast_to(boxes, (len(rows), 4))])


def tidied(curves: list[np.ndarray]) -> np.ndarray:
    """All curves (m, 10) that meet the film, each once, scaled to a largest coefficient of 1."""
    rows = np.concatenate([np.zeros((0, 10)), *curves])
    largest = np.abs(rows[:, :6]).max(axis=1)
    rows = rows[largest > 0]
    rows[:, :6] /= largest[largest > 0, None]
    rows[:, :6][np.abs(rows[:, :6]) < NOISE] = 0
    rows = rows[meets(rows)]
    leading = np.take_along_axis(rows, (np.abs(rows[:, :6]) > 0.5).argmax(axis=1)[:, None], axis=1)
    rows[:, :6] *= np.sign(leading)
    _, first, which = np.unique(np.round(rows[:, :6] / SAME), axis=0, return_index=True, return_inverse=True)
    merged = rows[first]
    for column, extreme in ((6, np.minimum), (7, np.maximum), (8, np.minimum), (9, np.maximum)):
        extreme.at(merged[:, column], which.ravel(), rows[:, column])
    return merged


def meets(rows: np.ndarray) -> np.ndarray:
    """Which curves (m, 10) may cross the square [-1/2, 1/2]^2 within their boxes."""
    reach = np.abs(rows[:, 1:3]).sum(axis=1) / 2 + np.abs(rows[:, 3:6]).sum(axis=1) / 4
    inside = (rows[:, [6, 8]] <= 0.5 + SAME).all(axis=1) & (rows[:, [7, 9]] >= -0.5 - SAME).all(axis=1)
    return (np.abs(rows[:, 0]) <= reach * (1 + SAME)) & inside & (rows[:, [6, 8]] <= rows[:, [7, 9]] + SAME).all(axis=1)
