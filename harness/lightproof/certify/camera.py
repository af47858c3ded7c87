"""A camera in exact numbers, and what it sees of a plane.

A film position (x, y) is that of the ray through x `right` + y `up`, two exact directions whose lengths have no square root
in them: everything that the camera sees is then bounded by lines in exact numbers. Roots and tangents enter in one place,
the pixels' size. A `pixel` takes the middle of that ball for it, and `blur` bounds what that changes of a pixel's mean.
"""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb, fmpq

from lightproof.certify import planes
from lightproof.certify.balls import Ball, Number, Point, Rational, Vector, cross, dot, exact, minus, plus, point, root, times
from lightproof.certify.planes import Line, Plane, Region
from lightproof.scene import CameraFilm

Ray = tuple[Vector, Vector]  # start and direction, of any length


@dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole or orthographic camera; `half` is how far along x and how far along y half its width reaches. Each is equal to
    itself alone: balls have no equality."""

    columns: int
    rows: int
    parallel: bool
    origin: Point
    right: Point
    up: Point
    forward: Point
    half: tuple[arb, arb]

    @classmethod
    def of(cls, film: CameraFilm) -> Camera:
        """The camera of a film."""
        forward = minus(point(film.target), point(film.origin))
        right = cross(forward, point(film.up))
        up = cross(right, forward)
        parallel = film.projection == "orthographic"
        far = arb(exact(film.width) / 2) if parallel else root(dot(forward, forward)) * (arb.pi() * exact(film.fov) / 360).tan()
        half = (far / root(dot(right, right)), far / root(dot(up, up)))
        return cls(*film.resolution, parallel, point(film.origin), right, up, forward, half)

    def ray(self, x: Number, y: Number) -> Ray:
        """The ray through a film position."""
        offset = plus(times(self.right, x), times(self.up, y))
        return (plus(self.origin, offset), self.forward) if self.parallel else (self.origin, plus(self.forward, offset))

    def within(self, element: int, s: Ball, t: Ball) -> Ray:
        """The ray through position (s, t) of a pixel's square, both from -1 to 1, t upwards."""
        row, column = divmod(element, self.columns)
        x = self.half[0] * (2 * column + 1 + s - self.columns) / self.columns
        return self.ray(x, self.half[1] * (self.rows - 2 * row - 1 + t) / self.columns)

    def pixel(self, element: int) -> Region:
        """The film positions of a pixel, but for a part `blur` of its area; counter-clockwise as the camera sees it."""
        row, column = divmod(element, self.columns)
        width, height = (fmpq(half.mid().fmpq()) / self.columns for half in self.half)
        left, right = ((2 * column - self.columns + i) * width for i in (0, 2))
        low, high = ((self.rows - 2 * row - i) * height for i in (2, 0))
        return (left, low), (right, low), (right, high), (left, high)

    def wide(self, pixel: Region) -> Region:
        """What holds a pixel and its true square: a little more on all sides."""
        (left, low), (right, high) = pixel[0], pixel[2]
        width, height = ((right - left) / 2**64, (high - low) / 2**64)
        left, low, right, high = left - width, low - height, right + width, high + height
        return (left, low), (right, low), (right, high), (left, high)

    @property
    def blur(self) -> arb:
        """Bounds how far a pixel's mean is from that over `pixel`, per largest value in either.

        Each of the four edges is off by at most d times its distance from the film's centre, d the relative error of `half`:
        by less than d (columns + rows) of the pixel's area together. A mean over one of two regions differs from that over the
        other by at most twice the share that they do not share; twice that again leaves room for which of them it is a share of.
        """
        error = max(((half - half.mid()) / half).abs_upper() for half in self.half)
        return 4 * (self.columns + self.rows) * error

    @property
    def film(self) -> Plane:
        """The plane through the origin across the view, in front of which there is something to see."""
        return Plane(self.forward, dot(self.forward, self.origin))


@dataclass(frozen=True)
class View:
    """The points of a plane by film position: a frame in which `direct` can average."""

    camera: Camera
    plane: Plane

    def at(self, x: Number, y: Number) -> Vector:
        """Where the ray through (x, y) meets the plane; for balls written around their middle, so that its ball is narrow.

        Off a ray along w by x r + y u the ray is along w + x r + y u, and with e = (x n.r + y n.u) / n.w it meets the plane off
        by reach (x (r - w n.r/n.w) + y (u - w n.u/n.w)) / (1 + e): by the same without reach and e where rays are parallel.
        """
        if isinstance(x, fmpq):
            start, along = self.camera.ray(x, y)
            return plus(start, times(along, self.reach(start, along)))
        start, along = self.camera.ray(x.mid(), y.mid())
        reach, off = self.reach(start, along), (x - x.mid(), y - y.mid())
        sides, normal = (self.camera.right, self.camera.up), self.plane.normal
        slopes = [dot(normal, side) / dot(normal, along) for side in sides]
        steps = [minus(side, times(along, slope)) for side, slope in zip(sides, slopes, strict=True)]
        scale = 1 if self.camera.parallel else reach / (1 + off[0] * slopes[0] + off[1] * slopes[1])
        offset = plus(times(steps[0], off[0] * scale), times(steps[1], off[1] * scale))
        return plus(plus(start, times(along, reach)), offset)

    def reach(self, start: Vector, along: Vector) -> Number:
        """How far along a ray it meets the plane, in lengths of `along`."""
        return -self.plane.height(start) / dot(self.plane.normal, along)

    def line(self, other: Plane) -> Line | None:
        """The film positions at which another plane is seen to meet this one; None where there are none, or all are."""
        constant, *ends = (self._above(other, fmpq(x), fmpq(y)) for x, y in ((0, 0), (1, 0), (0, 1)))
        return planes.scaled((constant, *(end - constant for end in ends)))

    def _above(self, other: Plane, x: Rational, y: Rational) -> Rational:
        """The other plane's height where a ray meets this plane, times a factor: linear in the film position."""
        start, along = self.camera.ray(x, y)
        mine, theirs = (dot(plane.normal, along) for plane in (self.plane, other))
        return other.height(start) * mine - self.plane.height(start) * theirs
