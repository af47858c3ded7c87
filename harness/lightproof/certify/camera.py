"""A camera's pixels in balls: the ray through any position of a pixel, analytic in that position."""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb

from lightproof.certify.balls import Ball, Point, Vector, cross, exact, minus, plus, point, times, unit
from lightproof.scene import CameraFilm


@dataclass(frozen=True)
class Camera:
    """A pinhole or orthographic camera."""

    film: CameraFilm
    origin: Point
    right: Vector
    up: Vector
    forward: Vector
    half: arb

    @classmethod
    def of(cls, film: CameraFilm) -> Camera:
        """The camera of a film; `half` is half its width, as a tangent or in metres."""
        forward = unit(minus(point(film.target), point(film.origin)))
        right = unit(cross(forward, point(film.up)))
        half = (arb.pi() * exact(film.fov) / 360).tan() if film.projection == "perspective" else exact(film.width) / 2
        return cls(film, point(film.origin), right, cross(right, forward), forward, arb(half))

    def ray(self, element: int, s: Ball, t: Ball) -> tuple[Vector, Vector]:
        """Origin and direction (of any length) through position (s, t) of a pixel's square, both from -1 to 1, t upwards."""
        columns, rows = self.film.resolution
        row, column = divmod(element, columns)
        x = self.half * (2 * column + 1 + s - columns) / columns
        y = self.half * (rows - 2 * row - 1 + t) / columns
        offset = plus(times(self.right, x), times(self.up, y))
        if self.film.projection == "orthographic":
            return plus(self.origin, offset), self.forward
        return self.origin, plus(self.forward, offset)
