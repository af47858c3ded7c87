"""The solid angle of suns, spheres and disks beside and behind polygons [sr].

A sun or a sphere is seen as a cap, of which polygons may hide a part. Round things have to be apart from one another, and a
disk from the polygons too.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import combinations

from flint import arb

from lightproof import geometry
from lightproof.certify import caps, disk_angle, rounded
from lightproof.certify.balls import CannotCertify, Point, dot, exact, minus, point
from lightproof.certify.caps import Cap
from lightproof.certify.loops import Region, shadow, union
from lightproof.certify.surroundings import Face, Surroundings
from lightproof.scene import AreaLight, SunDisc, Surface

Round = AreaLight | SunDisc | Surface


def sides(things: Iterable[AreaLight | Surface], x: Point) -> tuple[list[Round], list[Round]]:
    """Round things that show a light's front to a receiver, and others; disks turned to it."""
    bright, dark = [], []
    for thing in things:
        front = not _is_disk(thing) or dot(point(thing.shape.normal), minus(x, point(thing.shape.center))) >= 0
        (bright if front and isinstance(thing, AreaLight) else dark).append(thing if front else _turned(thing))
    return bright, dark


def _turned(thing: AreaLight | Surface) -> AreaLight | Surface:
    return replace(thing, shape=replace(thing.shape, normal=tuple(-component for component in thing.shape.normal)))


def beside(around: Surroundings, normal: Point | None, lights: Sequence[Round], screens: Sequence[Round]) -> arb:
    """What round lights add to the polygons seen, less what round screens hide of these. Raises CannotCertify."""
    if len(lights) == 1 and not screens and not around.faces and _is_disk(lights[0]):
        return disk_angle.solid_angle(lights[0].shape, around.x, normal)
    lights = [light for light in lights if not _is_covered(light, lights, screens, around)]
    outlines = [(thing, _outline(thing, around)) for thing in (*lights, *screens)]
    for (one, first), (other, second) in combinations(outlines, 2):
        if not caps.apart(first, second):
            raise CannotCertify(f"'{one.id}' and '{other.id}', which are round, may overlap as a receiver sees them; not covered")
    added = sum((_light(light, outline, around, normal) for light, outline in outlines[:len(lights)]), arb(0))
    return added - sum((_hidden(surface, outline, around) for surface, outline in outlines[len(lights):]), arb(0))


def _is_covered(light: Round, lights: Sequence[Round], screens: Sequence[Round], around: Surroundings) -> bool:
    """Whether a light adds nothing to a sphere that is seen all around it: a sun behind it, or anything where nothing is dark."""
    spheres = [thing for thing in (*lights, *screens) if _is_sphere(thing) and thing is not light]
    if not isinstance(light, SunDisc) and (screens or around.dark):
        return False
    return any(caps.within(_outline(light, around), _outline(sphere, around)) for sphere in spheres)


def _is_sphere(thing: Round) -> bool:
    return not isinstance(thing, SunDisc) and isinstance(thing.shape, geometry.Sphere)


def _is_disk(thing: Round) -> bool:
    return not isinstance(thing, SunDisc) and isinstance(thing.shape, geometry.Disk)


def _outline(thing: Round, around: Surroundings) -> Cap:
    """The cap in which a thing is seen, or which holds it."""
    if isinstance(thing, SunDisc):
        return caps.sun(thing)
    if isinstance(thing.shape, geometry.Sphere):
        return caps.ball(thing.shape, around.x)
    if isinstance(thing.shape, geometry.Disk):
        return caps.ball(geometry.Sphere(thing.shape.center, thing.shape.radius), around.x)
    raise CannotCertify(f"'{thing.id}' is a {type(thing.shape).__name__.lower()}, which a film of solid angle does not cover")


def _light(light: Round, outline: Cap, around: Surroundings, normal: Point | None) -> arb:
    """What a light shows beside all polygons that show already, or hide it."""
    if _is_disk(light):
        if any(_overlap(outline, _region(face, around), around) for face in around.faces):
            raise CannotCertify(f"a polygon may overlap disk '{light.id}' as a receiver sees them, which is not covered")
        return disk_angle.solid_angle(light.shape, around.x, normal)
    hiding = [face for face in around.dark if isinstance(light, SunDisc) or _before(face, light, outline, around)]
    taken = union(around.seen, shadow([tile for face in hiding for tile in face.tiles], around.x), around.x)
    whole = caps.whole(outline) if normal is None else caps.above(outline, normal)
    return rounded.solid_angle(whole) - _common(outline, taken, around)


def _hidden(screen: Round, outline: Cap, around: Surroundings) -> arb:
    """What a round surface hides of the polygons that are seen."""
    if not any(_overlap(outline, _region(face, around), around) for face in around.bright):
        return arb(0)
    if not isinstance(screen.shape, geometry.Sphere):
        raise CannotCertify(f"disk '{screen.id}' may hide a light, which is not covered")
    nearer = {not _before(face, screen, outline, around) for face in around.bright}
    if nearer == {True, False}:
        raise CannotCertify(f"sphere '{screen.id}' is behind one light and before another, which is not covered")
    return _common(outline, around.seen, around) if nearer == {True} else arb(0)


def _before(face: Face, thing: Round, outline: Cap, around: Surroundings) -> bool:
    """Whether a polygon is nearer than a sphere where both are seen, and not behind it. Raises CannotCertify."""
    if not _overlap(outline, _region(face, around), around):
        return False
    height, radius = face.plane.height(point(thing.shape.center)), exact(thing.shape.radius)
    if height * height < radius * radius * dot(face.plane.normal, face.plane.normal):
        raise CannotCertify(f"the plane of a polygon cuts sphere '{thing.id}', which is not covered")
    return height < 0


def _region(face: Face, around: Surroundings) -> Region:
    return shadow(face.tiles, around.x)


def _overlap(cap: Cap, region: Region, around: Surroundings) -> bool:
    return any(caps.shared(cap, loop, around.x) for loop in region)


def _common(cap: Cap, region: Region, around: Surroundings) -> arb:
    """Solid angle of what a cap shares with a region."""
    return sum((rounded.solid_angle(caps.shared(cap, loop, around.x)) for loop in region), arb(0))
