"""Skies and suns behind polygons: what the open sky gives, less what the polygons hide of it.

Polygons hide the directions in which they are seen, wherever they stand. Of a uniform sky they hide what Lambert's formula
gives for them as lights; of the overcast sky its second moments too; of a sun what they share with its disc.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from flint import arb, fmpq

from lightproof import geometry, scene
from lightproof.certify import caps, contact, emitters, planes, provenance
from lightproof.certify.balls import Ball, CannotCertify, Point, Vector, exact, point, unit
from lightproof.certify.contour import Contour
from lightproof.certify.emitters import Formula
from lightproof.certify.field import Field, Shape
from lightproof.certify.loops import Convex, cut, overlays, second_moment
from lightproof.certify.planes import Frame, Plane, Region
from lightproof.certify.polygon import Loop, convex_parts
from lightproof.certify.provenance import Provenance
from lightproof.certify.rounded import projected

Sky = scene.Environment | scene.OvercastSky | scene.SunDisc
OPEN = {scene.Environment: emitters.uniform_sky, scene.OvercastSky: emitters.overcast_sky, scene.SunDisc: emitters.sun}
Hidden = list[tuple[int, Loop]]  # with signs
UP = (fmpq(0), fmpq(0), fmpq(1))


def covers(light: scene.Light, blockers: list[Shape]) -> bool:
    """Whether this is a sky or a sun with polygons in front of it."""
    return isinstance(light, Sky) and bool(blockers) and all(isinstance(blocker, geometry.Polygon) for blocker in blockers)


def provenance_of(light: Sky, blockers: list[Shape]) -> Provenance:
    """Where the formula comes from."""
    return HIDDEN[type(light)]


HIDDEN = {
    scene.Environment: provenance.Provenance(
        "E = E₀ − (L/2) Σ θᵢ (gᵢ · n): the open sky's, less Lambert's sum over the edges of all that is seen of the blockers",
        "Lambert's formula for the blockers, as Arvo gives it, taken from the open sky's.",
        ("lambert1760", "arvo1995", "howell"),
    ),
    scene.OvercastSky: provenance.Provenance(
        "E = E₀ − (L_z/3) ∫ (1 + 2 w · z) (w · n) dw over all that is seen of the blockers, by their edges: Σ θᵢ (gᵢ · n)/2 and"
        " ∫ w wᵀ dw = (ω/3) 1 + (1/6) Σ (gᵢ dᵢᵀ + dᵢ gᵢᵀ), dᵢ = (vᵢ₊₁ − vᵢ) × gᵢ",
        "First and second moments of spherical polygons (Arvo's axial moments), taken from the open sky's.",
        ("lambert1760", "arvo1995", "moon1942"),
    ),
    scene.SunDisc: provenance.Provenance(
        "E = E₀ − (L/2) ∮ (w × dw) · n around what the blockers hide of the disc, along great circles and the disc's rim",
        "Lambert's contour integral, elementary along every circle, taken from the open sun's.",
        ("lambert1760", "snyder1996"),
    ),
}


def field(light: Sky, blockers: list[Shape], receiver: Plane) -> Field:
    """The light's irradiance on a plane's front. Raises CannotCertify."""
    screen = _Screen.of(light, blockers, receiver)
    open_sky, hidden = OPEN[type(light)](light, receiver), HIDES[type(light)]

    def near(x: Point) -> Formula:
        taken = hidden(light, screen.hidden(x), x, screen.normal)
        return lambda y: open_sky(y) - taken(y)

    reason = _curves(light, screen)
    return Field(near, None, refusal(reason)) if reason else Field(near, screen.events)


def refusal(reason: str) -> Callable[[Frame, Region], arb]:
    """In place of the flux through a film's cells."""
    def flux(frame: Frame, region: Region) -> arb:
        raise CannotCertify(reason)

    return flux


@dataclass(frozen=True)
class _Screen:
    """The polygons above a receiver's horizon, in convex tiles. `level` is whether the sky's own horizon, if it has one, is
    the receiver's."""

    receiver: Plane
    tiles: tuple[Convex, ...]
    level: bool

    @classmethod
    def of(cls, light: Sky, blockers: Sequence[geometry.Polygon], receiver: Plane) -> _Screen:
        """The part of the blockers that counts."""
        polygons = [[point(corner) for corner in blocker.vertices] for blocker in blockers]
        tiles = [part for corners in polygons for part in convex_parts(corners)]
        return cls(receiver, tuple(cut(tiles, receiver)), is_level(light, receiver))

    @property
    def normal(self) -> Vector:
        """Unit normal of the receivers."""
        return unit(self.receiver.normal)

    @property
    def planes(self) -> set[Plane]:
        """Of the polygons, each once."""
        return {_scaled(planes.of(tile)) for tile in self.tiles}

    @property
    def events(self) -> tuple[Plane, ...]:
        """The planes in which a polygon is seen edge-on, or a corner of one on an edge of another."""
        pairs = combinations(self.tiles, 2) if len(self.planes) > 1 else ()
        return (*self.planes, *(event for a, b in pairs for event in _corner_on_edge(a, b)))

    def hidden(self, x: Point) -> Hidden:
        """The directions above both horizons in which the polygons are seen."""
        seen = cut(contact.limit(self.tiles, x, self.receiver.normal), self.receiver)
        return overlays(seen if self.level else cut(seen, Plane(UP, x[2])), x)


def is_level(light: scene.Environment | scene.OvercastSky | scene.SunDisc, receiver: Plane) -> bool:
    """Whether a light has no horizon of its own, or the receiver's."""
    everywhere = isinstance(light, scene.SunDisc) or getattr(light, "extent", "upper") == "sphere"
    return everywhere or (receiver.normal[0] == receiver.normal[1] == 0 and receiver.normal[2] > 0)


def _curves(light: Sky, screen: _Screen) -> str:
    """Why the visible part of the light may change across curves on a film, where it may."""
    if isinstance(light, scene.SunDisc):
        return f"shadows in the sun '{light.id}' have curved edges, so means over them are not covered; points are"
    if not screen.level:
        return f"means over a tilted film, whose horizon is not that of the sky '{light.id}', are not covered behind polygons"
    if len(screen.planes) > 1 and len(screen.tiles) > 2:
        return "three convex polygons before a sky, not all in one plane, may meet in curves on the film, which are not covered"
    return ""


def _of_uniform(light: scene.Environment, hidden: Hidden, x: Point, normal: Vector) -> Formula:
    contours = [(sign, Contour.of(part, x)) for sign, part in hidden]
    return lambda y: exact(light.radiance) * sum((sign * part.irradiance(y, normal) for sign, part in contours), arb(0))


def _of_overcast(light: scene.OvercastSky, hidden: Hidden, x: Point, normal: Vector) -> Formula:
    contours = [(sign, Contour.of(part, x)) for sign, part in hidden]

    def taken(y: Vector) -> Ball:
        parts = (sign * (part.irradiance(y, normal) + 2 * second_moment(part, y, normal, UP)) for sign, part in contours)
        return exact(light.zenith_radiance) / 3 * sum(parts, arb(0))

    return taken


def _of_sun(light: scene.SunDisc, hidden: Hidden, x: Point, normal: Vector) -> Formula:
    disc = caps.sun(light)
    taken = sum((sign * projected(caps.shared(disc, part, x), normal) for sign, part in hidden), arb(0))
    return lambda y: exact(light.radiance) * taken


HIDES = {scene.Environment: _of_uniform, scene.OvercastSky: _of_overcast, scene.SunDisc: _of_sun}


def _scaled(plane: Plane) -> Plane:
    """The same plane, whichever way and however long its normal was."""
    leading = next(component for component in plane.normal if component)
    return Plane(tuple(component / leading for component in plane.normal), plane.offset / leading)


def _corner_on_edge(a: Convex, b: Convex) -> Iterator[Plane]:
    for corners, edges in ((a, b), (b, a)):
        yield from (planes.through(corner, edges[i - 1], edges[i]) for corner in corners for i in range(len(edges)))
