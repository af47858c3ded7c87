"""A disk light behind a disk on the same axis, over a plane film across that axis: the shadow depends on the radius alone.

The light that the blocker takes away is Lambert's contour integral around the lens in which the receiver sees both disks
overlap: an arc of the light's rim and one of the blocker's, each elementary. Its mean over a cell is a one-dimensional
integral over the radius of irradiance times the length of the circle's arc in the cell.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import pairwise

from flint import acb, arb

from lightproof import geometry
from lightproof.certify import direct, emitters, provenance
from lightproof.certify.balls import Ball, CannotCertify, Element, Number, arctan, cross, dot, exact, minus, point, root
from lightproof.certify.field import Field
from lightproof.certify.planes import Frame, Plane
from lightproof.certify.provenance import Provenance
from lightproof.scene import AreaLight, PlaneFilm, Scene, Surface

GOAL = 2.0**-64  # of each piece: radiance times square metres


def covers(scene_: Scene) -> bool:
    """Whether a disk light stands over a disk blocker, and both and a rectangular film lie across one axis."""
    things = (*scene_.lights, *scene_.surfaces)
    shapes = [thing.shape for thing in things if isinstance(thing, AreaLight | Surface)]
    if not isinstance(scene_.film, PlaneFilm) or len(things) != len(scene_.surfaces) + 1:
        return False
    return list(map(type, shapes)) == [geometry.Disk] * 2 and _coaxial(Frame.of(scene_.film), *shapes)


def _coaxial(frame: Frame, light: geometry.Disk, blocker: geometry.Disk) -> bool:
    n = frame.plane.normal
    low, high = (frame.plane.height(point(shape.center)) for shape in (blocker, light))
    across = [point(light.normal), point(blocker.normal), minus(point(blocker.center), point(light.center))]
    straight = not any(any(cross(n, vector)) for vector in across) and dot(frame.u, frame.v) == 0
    return straight and 0 < low < high and dot(point(light.normal), n) < 0


def kind(scene_: Scene) -> str:
    """Rigorous integrals over the radius."""
    return "enclosure"


def provenance_of(scene_: Scene) -> Provenance:
    """Where the formula comes from."""
    return provenance.DISK_SHADOW


@dataclass(frozen=True)
class Disk:
    """A disk across the axis: radius and height above the film."""

    radius: Number
    height: Number

    def whole(self, r: Ball) -> Ball:
        """Irradiance per radiance [sr] at distance r from the axis, from all of it."""
        p = self.radius * self.radius + self.height * self.height + r * r
        d = root(p * p - 4 * (self.radius * r) ** 2)
        return arb.pi() / 2 * (1 - (p - 2 * self.radius * self.radius) / d)

    def arc(self, r: Ball, half: Ball, towards: int) -> Ball:
        """The part of the contour integral along an arc of the rim that extends an angle on both sides of the direction
        towards the receiver (+1) or away from it (-1); `half` is the tangent of half that angle."""
        p = self.radius * self.radius + self.height * self.height + r * r
        q = 2 * towards * self.radius * r
        d = root(p * p - q * q)
        return arctan(half) + (self.radius * self.radius - self.height * self.height - r * r) / d * arctan(d / (p - q) * half)


@dataclass(frozen=True)
class Shadow:
    """What a blocker hides of a light, as a function of the distance r from their axis."""

    light: Disk
    blocker: Disk

    @property
    def scale(self) -> Number:
        """Blocker's height over light's: how much smaller the light looks in the blocker's plane."""
        return self.blocker.height / self.light.height

    @property
    def umbra(self) -> bool:
        """Whether the blocker hides all of the light from near the axis."""
        return bool(self.light.radius * self.scale <= self.blocker.radius)

    @property
    def rims(self) -> tuple[Number, Number]:
        """The distances at which the two rims are seen to touch, from inside and from outside."""
        small, large = sorted((self.blocker.radius, self.light.radius * self.scale))
        return (large - small) / (1 - self.scale), (large + small) / (1 - self.scale)

    def inner(self, r: Ball) -> Ball:
        """Hidden irradiance per radiance [sr] where one disk covers the other: the smaller one's."""
        return (self.light if self.umbra else self.blocker).whole(r)

    def lens(self, r: Ball) -> Ball:
        """Hidden irradiance per radiance [sr] where the rims are seen to cross."""
        light, blocker, s = self.light.radius * self.scale, self.blocker.radius, (1 - self.scale) * r
        outer, near, far, total = blocker + light - s, s + blocker - light, s + light - blocker, s + light + blocker
        of_light = root(outer * near / (far * total))
        of_blocker = root(outer * far / (near * total))
        return self.light.arc(r, of_light, -1) + self.blocker.arc(r, of_blocker, 1)


def solve(scene_: Scene) -> Element:
    """Mean irradiance of each cell. Raises CannotCertify."""
    frame = Frame.of(scene_.film)
    light, blocker = scene_.lights[0], scene_.surfaces[0]
    if scene_.reflects or blocker.radiance > 0:
        raise CannotCertify("a blocker that reflects or emits light is not covered")
    axis = point(light.shape.center)
    formula = emitters.disk_light(light.shape, light.radiance, frame.plane)
    open_light = [Field(lambda x: formula)]
    shadow = Shadow(*(_disk(shape, frame) for shape in (light.shape, blocker.shape)))
    hidden = cache(lambda column, row: _corner(shadow, *_offset(frame, axis, column, row)))

    def element(index: int) -> arb:
        row, column = divmod(index, frame.columns)
        corners = [root(sum(x * x for x in _offset(frame, axis, column + i, row + j))) for i in (0, 1) for j in (0, 1)]
        if shadow.umbra and all(corner < shadow.rims[0] for corner in corners):
            return arb(0)
        taken = hidden(column + 1, row + 1) - hidden(column, row + 1) - hidden(column + 1, row) + hidden(column, row)
        cell = root(dot(frame.u, frame.u) * dot(frame.v, frame.v)) / (frame.columns * frame.rows)
        return direct.mean_over(frame, open_light, frame.cell(index)) - exact(light.radiance) * taken / cell

    return element


def _disk(shape: geometry.Disk, frame: Frame) -> Disk:
    plane: Plane = frame.plane
    return Disk(exact(shape.radius), plane.height(point(shape.center)) / root(dot(plane.normal, plane.normal)))


def _offset(frame: Frame, axis: tuple, column: int, row: int) -> tuple[arb, arb]:
    """Where a corner of the grid is, along u and v from the axis [m]."""
    corner = minus(frame.at(exact(column) / frame.columns, exact(row) / frame.rows), axis)
    return tuple(dot(corner, side) / root(dot(side, side)) for side in (frame.u, frame.v))


def _corner(shadow: Shadow, a: arb, b: arb) -> arb:
    """The integral of the hidden irradiance over the rectangle from the axis to (a, b), negative where just one of a, b is."""
    if a < 0:
        return -_corner(shadow, -a, b)
    if b < 0:
        return -_corner(shadow, a, -b)
    if not (a > 0 and b > 0):
        return arb(0, abs(a * b * shadow.light.whole(arb(0))).abs_upper())
    inner, outer, far = *map(arb, shadow.rims), root(a * a + b * b)
    last = min(outer, far, key=arb.mid)
    ends = sorted((arb(0), a, b, far, inner, outer), key=arb.mid)
    pieces = [(p, q) for p, q in pairwise(ends) if p < q and not q > last]
    return sum((_piece(shadow, (a, b), p, q) + _piece(shadow, (a, b), q, p) for p, q in pieces), arb(0))


def _piece(shadow: Shadow, sides: tuple[arb, arb], start: arb, end: arb) -> arb:
    """That integral from a distance half way to another. With r = start +- u^2 square roots vanish as u does."""
    half = (end - start) / 2
    middle, sign = start + half, 1 if half > 0 else -1
    hidden = shadow.inner if middle < shadow.rims[0] else shadow.lens
    passed = [side for side in sides if middle > side]

    def integrand(u: acb, analytic: bool) -> acb:
        r = start + sign * u * u
        arc = arb.pi() / 2 - sum((arctan(root((r - side) * (r + side)) / side) for side in passed), arb(0))
        value = hidden(r) * arc * r * 2 * u
        return value if analytic or value.is_finite() else _bound(shadow, r, u)

    return acb.integral(integrand, 0, root(abs(half)), abs_tol=GOAL).real


def _bound(shadow: Shadow, r: acb, u: acb) -> acb:
    """Holds the integrand where a ball reaches a rim: between nothing and all of the light, over a quarter turn at most."""
    most = (shadow.light.whole(r) * arb.pi() * r * u).abs_upper()
    return acb(arb(0, most))


