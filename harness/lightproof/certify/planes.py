"""Exact planes, and the cells of a plane film cut along the lines where planes meet it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from flint import arb, fmpq

from lightproof.certify.balls import Ball, Point, Rational, Vector, cross, dot, exact, minus, plus, point, times, unit
from lightproof.certify.polygon import area_vector
from lightproof.scene import PlaneFilm

Flat = tuple[Rational, Rational]  # position on a film: 0 to 1 along u and along v
Line = tuple[Rational, Rational, Rational]  # the positions (p, q) where a + b p + c q = 0
Region = tuple[Flat, ...]  # a convex polygon


@dataclass(frozen=True)
class Plane:
    """The points x with normal . x = offset; its front is where normal . x is greater. `normal` has any length."""

    normal: Point
    offset: Rational

    def height(self, x: Vector) -> Ball:
        """normal . x - offset: positive in front."""
        return dot(self.normal, x) - self.offset

    def parts(self, above: Iterable[Point], below: Iterable[Point]) -> bool:
        """Whether some points are in front of the plane or on it, and others behind it or on it."""
        return all(self.height(x) >= 0 for x in above) and all(self.height(x) <= 0 for x in below)

    @property
    def turned(self) -> Plane:
        """The same plane with its front on the other side."""
        return Plane(times(self.normal, -1), -self.offset)


def of(corners: Sequence[Point]) -> Plane:
    """The plane of a polygon, its front the polygon's."""
    normal = area_vector(corners)
    return Plane(normal, dot(normal, corners[0]))


def through(a: Point, b: Point, c: Point) -> Plane:
    """The plane through three points."""
    normal = cross(minus(b, a), minus(c, a))
    return Plane(normal, dot(normal, a))


@dataclass(frozen=True)
class Frame:
    """A plane film in exact numbers."""

    origin: Point
    u: Point
    v: Point
    columns: int
    rows: int

    @classmethod
    def of(cls, film: PlaneFilm) -> Frame:
        """The frame of a film."""
        return cls(point(film.origin), point(film.u), point(film.v), *film.resolution)

    @property
    def plane(self) -> Plane:
        """The film's plane, its front the receiving side."""
        normal = cross(self.u, self.v)
        return Plane(normal, dot(normal, self.origin))

    @property
    def normal(self) -> Vector:
        """Unit normal of the receiving side."""
        return unit(self.plane.normal)

    def at(self, p: Ball, q: Ball) -> Vector:
        """The point at position (p, q)."""
        return plus(self.origin, plus(times(self.u, p), times(self.v, q)))

    def cell(self, element: int) -> Region:
        """An element's corners, counter-clockwise."""
        row, column = divmod(element, self.columns)
        left, right = exact(column) / self.columns, exact(column + 1) / self.columns
        low, high = exact(row) / self.rows, exact(row + 1) / self.rows
        return (left, low), (right, low), (right, high), (left, high)

    def line(self, plane: Plane) -> Line | None:
        """Where a plane meets the film's plane, scaled so that equal lines are equal; None where they are parallel."""
        return scaled((plane.height(self.origin), dot(plane.normal, self.u), dot(plane.normal, self.v)))


def scaled(line: Line) -> Line | None:
    """The line, so that equal lines are equal; None where a + b p + c q is the same everywhere."""
    leading = line[1] or line[2]
    return tuple(number / leading for number in line) if leading else None


def cut(region: Region, lines: Iterable[Line]) -> list[Region]:
    """The convex regions into which lines cut a convex region."""
    regions = [region]
    for line in lines:
        regions = [part for whole in regions for part in _halves(whole, line)]
    return regions


def _halves(region: Region, line: Line) -> list[Region]:
    heights = [line[0] + line[1] * p + line[2] * q for p, q in region]
    if all(height >= 0 for height in heights) or all(height <= 0 for height in heights):
        return [region]
    return [_side(region, heights), _side(region, [-height for height in heights])]


def _side(region: Region, heights: Sequence[Rational]) -> Region:
    """The part of a convex region where the heights of its corners, interpolated, are positive."""
    kept = []
    for i, (here, height) in enumerate(zip(region, heights, strict=True)):
        before, depth = region[i - 1], heights[i - 1]
        if height * depth < 0:
            share = depth / (depth - height)
            kept.append((before[0] + (here[0] - before[0]) * share, before[1] + (here[1] - before[1]) * share))
        if height >= 0:
            kept.append(here)
    return tuple(kept)


def in_front(frame: Frame, region: Region, plane: Plane) -> list[Region]:
    """The part of a region that is in front of a plane."""
    line = frame.line(plane)
    return [part for part in cut(region, [line] if line else []) if plane.height(frame.at(*centre(part))) > 0]


def chord(region: Region, line: Line) -> tuple[Flat, Flat] | None:
    """The ends of the part of a line that is inside a convex region; None where it does not pass through."""
    heights = [line[0] + line[1] * p + line[2] * q for p, q in region]
    if all(height >= 0 for height in heights) or all(height <= 0 for height in heights):
        return None
    sides = (_side(region, heights), _side(region, [-height for height in heights]))
    first, second = (end for end in sides[0] if end in sides[1])
    return first, second


def inside(region: Region) -> Flat:
    """A point inside a region near its centre, with as few digits as it takes."""
    middle, bits = centre(region), 16
    while True:
        near = tuple(fmpq((axis * 2**bits).floor()) / 2**bits for axis in middle)
        if all(area((region[i - 1], region[i], near)) > 0 for i in range(len(region))):
            return near
        bits *= 2


def centre(region: Region) -> Flat:
    """The mean of a region's corners: a point inside it."""
    return tuple(sum(axis, fmpq(0)) / len(region) for axis in zip(*region, strict=True))


def area(region: Region) -> Rational:
    """Area in film positions."""
    ends = (*region[1:], region[0])
    return sum((a[0] * b[1] - b[0] * a[1] for a, b in zip(region, ends, strict=True)), fmpq(0)) / 2


@dataclass(frozen=True)
class Patch:
    """A convex quadrilateral as the bilinear image of the square [-1, 1]^2: position = m + s a + t b + s t c."""

    m: tuple[Ball, Ball]
    a: tuple[Ball, Ball]
    b: tuple[Ball, Ball]
    c: tuple[Ball, Ball]

    @classmethod
    def of(cls, corners: Sequence[Flat]) -> Patch:
        """The patch with these four corners, counter-clockwise; two neighbours may be equal."""
        signs = ((1, 1, 1, 1), (-1, 1, 1, -1), (-1, -1, 1, 1), (1, -1, 1, -1))
        axes = list(zip(*corners, strict=True))
        return cls(*(tuple(arb(_signed(row, axis) / 4) for axis in axes) for row in signs))

    def at(self, s: Ball, t: Ball) -> tuple[Ball, Ball]:
        """The position of (s, t)."""
        return tuple(m + s * a + t * (b + s * c) for m, a, b, c in zip(self.m, self.a, self.b, self.c, strict=True))

    def jacobian(self, s: Ball, t: Ball) -> Ball:
        """Area in film positions per area of the square."""
        along_s = [a + t * c for a, c in zip(self.a, self.c, strict=True)]
        along_t = [b + s * c for b, c in zip(self.b, self.c, strict=True)]
        return along_s[0] * along_t[1] - along_s[1] * along_t[0]


def _signed(signs: Sequence[int], numbers: Sequence[Rational]) -> Rational:
    return sum((sign * number for sign, number in zip(signs, numbers, strict=True)), fmpq(0))


def patches(region: Region) -> list[Patch]:
    """Quadrilaterals, the last perhaps a triangle, that tile a convex region."""
    fan = [(region[0], *region[i:i + 3]) for i in range(1, len(region) - 1, 2)]
    return [Patch.of(corners if len(corners) == 4 else (*corners, corners[-1])) for corners in fan]
