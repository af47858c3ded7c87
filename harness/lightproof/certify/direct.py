"""Direct irradiance: the sum over lights of what reaches a receiver straight, at points and as means over film elements.

Each light, with what may stand before it, is known by one module of FIELDS, which has `covers(light, blockers)`,
`provenance_of(light, blockers)` and `field(light, blockers, receiver)`; the first that covers it is asked.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from types import ModuleType

from flint import arb

from lightproof import geometry, scene
from lightproof.certify import (
    between,
    contact,
    curved,
    emitters,
    flux,
    hard_shadows,
    planes,
    provenance,
    shadows,
    skies,
    skies_curved,
    unblocked,
)
from lightproof.certify.balls import CannotCertify, Element, Point, dot, exact, point
from lightproof.certify.field import Field, Shape
from lightproof.certify.planes import Frame, Plane, Region
from lightproof.certify.provenance import Provenance
from lightproof.scene import AreaLight, Film, PlaneFilm, PointsFilm, Scene, Surface

FIELDS: tuple[ModuleType, ...] = (curved, shadows, hard_shadows, skies, skies_curved, unblocked)
ROUNDING = exact(1e-15)  # of a corner's coordinates: how far above a plane a corner counts as lying on it


def covers(scene_: Scene) -> bool:
    """Whether the film is one that receives; what stands in the way of an answer, `solve` says."""
    return isinstance(scene_.film, PlaneFilm | PointsFilm) and scene_.film.quantity == "irradiance"


def kind(scene_: Scene) -> str:
    """Points and smooth means are proven; means behind curves are estimated."""
    estimated = isinstance(scene_.film, PlaneFilm) and any(_module(*pair) is curved for pair in _with_blockers(scene_))
    return "quadrature" if estimated else "enclosure"


def provenance_of(scene_: Scene) -> Provenance:
    """That of each light, joined."""
    pairs = _with_blockers(scene_)
    return provenance.joined(_module(light, blockers).provenance_of(light, blockers) for light, blockers in pairs)


def _with_blockers(scene_: Scene) -> list[tuple[scene.Light, list[Shape]]]:
    """Each light, and what may stand between it and the film's receivers."""
    return [(light, _blockers(scene_, light, _corners(scene_.film))) for light in scene_.lights]


def fields(scene_: Scene, receiver: Plane, where: Sequence[Point] | None = None, on: Sequence[Shape] = ()) -> list[Field]:
    """One field a light for receivers on the front of a plane: anywhere on it, or between some points of it, or on some shapes.
    Raises CannotCertify."""
    for surface in scene_.surfaces:
        if surface.radiance > 0:
            raise CannotCertify(f"surface '{surface.id}' emits light of its own; give it as an area light")
    above = [(light, [shape for shape in _blockers(scene_, light, where, on) if not lies_on(shape, receiver)])
             for light in scene_.lights]
    return [_module(light, blockers).field(light, blockers, receiver) for light, blockers in above]


def _blockers(scene_: Scene, light: scene.Light, where: Sequence[Point] | None, on: Sequence[Shape] = ()) -> list[Shape]:
    """What may stand between a light and receivers, which may be anywhere, or are between some points, or on some shapes."""
    shapes = [item.shape for item in _things(scene_) if item is not light]
    return [shape for shape in shapes if where is None or shape in on or between.may_hide(shape, light, where)]


def _things(scene_: Scene) -> list[AreaLight | Surface]:
    return [thing for thing in (*scene_.lights, *scene_.surfaces) if isinstance(thing, AreaLight | Surface)]


def _corners(film: Film) -> list[Point] | None:
    """Points between which all receivers of a film are; None for a camera's."""
    if isinstance(film, PlaneFilm):
        frame = Frame.of(film)
        return [frame.at(exact(p), exact(q)) for p in (0, 1) for q in (0, 1)]
    return [point(position) for position in film.positions] if isinstance(film, PointsFilm) else None


def lies_on(shape: Shape, plane: Plane) -> bool:
    """Whether a polygon has no part in front of the plane, but for the rounding of its corners: it then blocks nothing."""
    if not isinstance(shape, geometry.Polygon):
        return False
    corners = [point(corner) for corner in shape.vertices]
    largest = max(abs(number) for corner in corners for number in corner)
    slack = (ROUNDING * largest) ** 2 * dot(plane.normal, plane.normal)
    return all((height := plane.height(corner)) <= 0 or height * height <= slack for corner in corners)


def _module(light: scene.Light, blockers: list[Shape]) -> ModuleType:
    for module in FIELDS:
        if module.covers(light, blockers):
            return module
    raise CannotCertify(f"something may stand before light '{light.id}'; that is not covered")


def mean_over(frame: Frame, lights: list[Field], region: Region) -> arb:
    """Mean irradiance over a convex region of a plane film. Raises CannotCertify."""
    others = [light for light in lights if light.flux is None]
    if any(light.events is None for light in others):
        raise CannotCertify("what is seen of a light changes along curves of the film; that is covered at points only")
    lines = {line for light in others for event in light.events if (line := frame.line(event))}
    total = sum((_flux(frame, others, part) for part in planes.cut(region, sorted(lines))), arb(0))
    total += sum((light.flux(frame, region) for light in lights if light.flux), arb(0))
    return total / planes.area(region)


def _flux(frame: Frame, lights: list[Field], region: Region) -> arb:
    """Integral over film positions of a region that no event crosses."""
    middle = frame.at(*planes.centre(region))
    formulas = [formula for light in lights if (formula := light.near(middle)) is not emitters.dark]
    if not formulas:
        return arb(0)
    return flux.through(frame, region, lambda x: sum((formula(x) for formula in formulas), arb(0)))


def solve(scene_: Scene) -> Element:
    """The irradiance of a plane or points film, element by element. Raises CannotCertify."""
    if scene_.reflects:
        raise CannotCertify("light reflected between surfaces is covered in a sphere of one or two zones, between concentric"
                            " spheres, in closed rooms alike all over, and from polygons that beams light evenly")
    _check_overlaps(scene_)
    film = scene_.film
    if isinstance(film, PointsFilm):
        return lambda element: at_point(scene_, film.positions[element], film.normals[element])
    frame = Frame.of(film)
    lights = fields(scene_, frame.plane, _corners(film))
    return lambda element: mean_over(frame, lights, frame.cell(element))


def at_point(scene_: Scene, position: geometry.Vec3, normal: geometry.Vec3) -> arb:
    """Irradiance of one receiver. Raises CannotCertify."""
    x, n = point(position), point(normal)
    receiver = Plane(n, dot(n, x))
    _check_contact(scene_, x, receiver)
    on = [thing.shape for thing in _things(scene_) if contact.touches(thing.shape, x, n)]
    return sum((light.near(x)(x) for light in fields(scene_, receiver, [x], on)), arb(0))


def _check_overlaps(scene_: Scene) -> None:
    """Where a light and something else share a part of a plane, either may be the one that is seen. Raises CannotCertify."""
    for one, other in combinations(filter(_is_polygon, (*scene_.lights, *scene_.surfaces)), 2):
        if isinstance(one, AreaLight) and contact.overlap(one.shape, other.shape):
            raise CannotCertify(f"'{one.id}' and '{other.id}' overlap in one plane, where either may be seen; part them")


def _check_contact(scene_: Scene, x: Point, receiver: Plane) -> None:
    """A receiver may lie on polygons, where there are no other shapes, nor lights but skies. Raises CannotCertify."""
    things = _things(scene_)
    flat = all(map(_is_polygon, things)) and all(isinstance(light, AreaLight | skies.Sky) for light in scene_.lights)
    for thing in things:
        if not flat and not lies_on(thing.shape, receiver) and contact.touches(thing.shape, x, receiver.normal):
            raise CannotCertify(f"a receiver lies on '{thing.id}'; that is covered where all lights and surfaces are polygons"
                                " or skies")


def _is_polygon(thing: scene.Light | Surface) -> bool:
    return isinstance(getattr(thing, "shape", None), geometry.Polygon)
