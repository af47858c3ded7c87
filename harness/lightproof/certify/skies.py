"""Skies and suns behind blockers: what the open sky gives, less what the blockers hide of it.

Blockers hide the directions in which they are seen, wherever they stand. Of a uniform sky they hide what Lambert's formula
gives for them as lights; of the overcast sky its second moments too; of a sun what they share with its disc.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations, product

from flint import arb, fmpq

from lightproof import geometry, scene
from lightproof.certify import caps, emitters, planes, provenance
from lightproof.certify.balls import Ball, CannotCertify, Point, Vector, exact, point, unit
from lightproof.certify.caps import Cap
from lightproof.certify.contour import Contour
from lightproof.certify.emitters import Formula
from lightproof.certify.field import Field, Shape
from lightproof.certify.loops import Region, cut, second_moment, shadow
from lightproof.certify.planes import Plane
from lightproof.certify.polygon import Parts, convex_parts
from lightproof.certify.provenance import Provenance
from lightproof.certify.rounded import projected

Sky = scene.Environment | scene.OvercastSky | scene.SunDisc
OPEN = {scene.Environment: emitters.uniform_sky, scene.OvercastSky: emitters.overcast_sky, scene.SunDisc: emitters.sun}
UP = (fmpq(0), fmpq(0), fmpq(1))


def covers(light: scene.Light, blockers: list[Shape]) -> bool:
    """Whether this is a sky or a sun with something in front of it."""
    return isinstance(light, Sky) and bool(blockers)


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
    """The light's irradiance on a plane's front, behind polygons and spheres. Raises CannotCertify."""
    screen = _screen(light, blockers, receiver)
    open_sky, hidden = OPEN[type(light)](light, receiver), HIDES[type(light)]

    @cache
    def near(x: Point) -> Formula:
        taken = hidden(light, screen, x)
        return lambda y: open_sky(y) - taken(y)

    return Field(near, _events(light, screen))


@dataclass(frozen=True)
class _Screen:
    """What stands above a receiver's horizon: polygons in convex parts, and spheres. `level` is whether the sky's own horizon,
    if it has one, is the receiver's."""

    receiver: Plane
    polygons: tuple[Parts, ...]
    spheres: tuple[geometry.Sphere, ...]
    level: bool

    @property
    def normal(self) -> Vector:
        """Unit normal of the receivers."""
        return unit(self.receiver.normal)

    def shadow(self, x: Point) -> Region:
        """The directions above both horizons in which the polygons are seen."""
        return shadow(self.polygons if self.level else [cut(polygon, Plane(UP, x[2])) for polygon in self.polygons], x)


def _screen(light: Sky, blockers: Sequence[Shape], receiver: Plane) -> _Screen:
    for blocker in blockers:
        if not isinstance(blocker, geometry.Polygon | geometry.Sphere):
            raise CannotCertify(f"a {type(blocker).__name__.lower()} stands before '{light.id}'; only polygons and spheres may")
    polygons = [tuple(map(point, blocker.vertices)) for blocker in blockers if isinstance(blocker, geometry.Polygon)]
    above = filter(None, (cut(convex_parts(corners), receiver) for corners in polygons))
    spheres = tuple(blocker for blocker in blockers if isinstance(blocker, geometry.Sphere))
    return _Screen(receiver, tuple(above), spheres, _level(light, receiver))


def _level(light: Sky, receiver: Plane) -> bool:
    everywhere = isinstance(light, scene.SunDisc) or getattr(light, "extent", "upper") == "sphere"
    return everywhere or (receiver.normal[0] == receiver.normal[1] == 0 and receiver.normal[2] > 0)


def _of_uniform(light: scene.Environment, screen: _Screen, x: Point) -> Formula:
    normal, region = screen.normal, screen.shadow(x)
    balls = [(_round(sphere, screen, x), emitters.sphere_light(sphere, 1.0, screen.receiver)) for sphere in screen.spheres]
    if not all(caps.apart(a, b) for (a, _), (b, _) in combinations(balls, 2)):
        raise CannotCertify(f"two spheres before '{light.id}' overlap as a receiver sees them, which is not covered")
    contours = [(Contour.of(loop, x), count) for loop, count in region.items()]
    twice = [(caps.shared(cap, loop, x), count) for cap, _ in balls for loop, count in region.items()]

    def taken(y: Vector) -> Ball:
        whole = sum((count * contour.irradiance(y, normal) for contour, count in contours), arb(0))
        whole += sum((formula(y) for _, formula in balls), arb(0))
        return exact(light.radiance) * (whole - sum((count * projected(part, normal) for part, count in twice), arb(0)))

    return taken


def _round(sphere: geometry.Sphere, screen: _Screen, x: Point) -> Cap:
    """The cap in which a sphere is seen. Raises CannotCertify where the sky's own horizon cuts it."""
    cap = caps.ball(sphere, x)
    if not screen.level and (cap.meets(UP) or cap.axis[2] < 0):
        raise CannotCertify("a sphere reaches below the horizon of the sky, which a tilted receiver sees; that is not covered")
    return cap


def _of_overcast(light: scene.OvercastSky, screen: _Screen, x: Point) -> Formula:
    if screen.spheres:
        raise CannotCertify(f"a sphere stands before '{light.id}'; only polygons are covered before an overcast sky")
    normal, contours = screen.normal, [(Contour.of(loop, x), count) for loop, count in screen.shadow(x).items()]

    def taken(y: Vector) -> Ball:
        parts = (count * (part.irradiance(y, normal) + 2 * second_moment(part, y, normal, UP)) for part, count in contours)
        return exact(light.zenith_radiance) / 3 * sum(parts, arb(0))

    return taken


def _of_sun(light: scene.SunDisc, screen: _Screen, x: Point) -> Formula:
    disc = caps.sun(light)
    balls = [caps.ball(sphere, x) for sphere in screen.spheres]
    if any(caps.within(disc, ball) for ball in balls):
        return OPEN[scene.SunDisc](light, screen.receiver)
    if not all(caps.apart(disc, ball) for ball in balls):
        raise CannotCertify(f"a sphere hides a part of '{light.id}'; it is covered where it hides all of it or nothing")
    parts = [(caps.shared(disc, loop, x), count) for loop, count in screen.shadow(x).items()]
    hidden = exact(light.radiance) * sum((count * projected(part, screen.normal) for part, count in parts), arb(0))
    return lambda y: hidden


HIDES = {scene.Environment: _of_uniform, scene.OvercastSky: _of_overcast, scene.SunDisc: _of_sun}


def _events(light: Sky, screen: _Screen) -> tuple[Plane, ...] | None:
    """The planes in which a polygon is seen edge-on, or a corner of one on an edge of another. None where the visible sky also
    changes across curves: round things before or behind polygons, three polygons that are not in one plane, a horizon of the
    sky's own."""
    one_sphere = len(screen.spheres) == 1 and not screen.polygons
    if isinstance(light, scene.SunDisc) or not screen.level or (screen.spheres and not one_sphere):
        return None
    faces = {_scaled(planes.of(corners)) for polygon in screen.polygons for _, corners in polygon}
    if len(faces) > 1 and len(screen.polygons) > 2:
        return None
    pairs = combinations(screen.polygons, 2) if len(faces) > 1 else ()
    return (*faces, *(event for a, b in pairs for event in _corner_on_edge(a, b)))


def _scaled(plane: Plane) -> Plane:
    """The same plane, whichever way and however long its normal was."""
    leading = next(component for component in plane.normal if component)
    return Plane(tuple(component / leading for component in plane.normal), plane.offset / leading)


def _corner_on_edge(a: Parts, b: Parts) -> Iterator[Plane]:
    for (_, first), (_, second) in product(a, b):
        for corners, edges in ((first, second), (second, first)):
            yield from (planes.through(corner, edges[i - 1], edges[i]) for corner in corners for i in range(len(edges)))
