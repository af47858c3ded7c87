"""Direct irradiance: the sum over lights of what reaches a receiver straight, at points and as means over film elements."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache

from flint import arb

from lightproof import geometry, scene
from lightproof.certify import emitters, planes, quadrature
from lightproof.certify.balls import Ball, CannotCertify, Element, Point, dot, exact, point, unit
from lightproof.certify.emitters import Formula
from lightproof.certify.planes import Frame, Patch, Plane, Region
from lightproof.certify.polygon import Parts, clip, convex_parts, lambert, visible
from lightproof.scene import AreaLight, Scene

Shape = geometry.Shape
ROUNDING = exact(1e-15)  # of a corner's coordinates: how far above a plane a corner counts as lying on it


@dataclass(frozen=True)
class Field:
    """Irradiance on one side of a plane from one light: `near(point)` is the formula that holds around a point of the plane,
    up to the next of the planes `events`, where the light's visible shape changes (None: across curved surfaces too)."""

    near: Callable[[Point], Formula]
    events: tuple[Plane, ...] | None = ()


def fields(scene_: Scene, receiver: Plane) -> list[Field]:
    """One field a light for receivers on the front of a plane. Raises CannotCertify."""
    for surface in scene_.surfaces:
        if surface.radiance > 0:
            raise CannotCertify(f"surface '{surface.id}' emits light of its own; give it as an area light")
    lights = [light for light in scene_.lights if isinstance(light, AreaLight)]
    shapes = {item.id: item.shape for item in (*lights, *scene_.surfaces) if not _lies_on(item.shape, receiver)}
    return [_field(light, [shape for name, shape in shapes.items() if name != light.id], receiver) for light in scene_.lights]


def _lies_on(shape: Shape, plane: Plane) -> bool:
    """Whether a polygon has no part in front of the plane, but for the rounding of its corners: it then blocks nothing."""
    if not isinstance(shape, geometry.Polygon):
        return False
    corners = [point(corner) for corner in shape.vertices]
    largest = max(abs(number) for corner in corners for number in corner)
    slack = (ROUNDING * largest) ** 2 * dot(plane.normal, plane.normal)
    return all((height := plane.height(corner)) <= 0 or height * height <= slack for corner in corners)


def _field(light: scene.Light, blockers: list[Shape], receiver: Plane) -> Field:
    if isinstance(light, AreaLight) and isinstance(light.shape, geometry.Polygon):
        return _polygon(light.shape, light.radiance, blockers, receiver)
    if blockers:
        raise CannotCertify(f"something may stand before light '{light.id}'; shadows are covered for polygon lights only")
    if isinstance(light, AreaLight):
        return _round(light, receiver)
    formula = UNBLOCKED[type(light)](light, receiver)
    return Field(lambda x: formula)


UNBLOCKED: dict[type, Callable[[scene.Light, Plane], Formula]] = {
    scene.PointLight: emitters.point_light,
    scene.DirectionalLight: emitters.beam,
    scene.Environment: emitters.uniform_sky,
    scene.OvercastSky: emitters.overcast_sky,
    scene.SunDisc: emitters.sun,
}


def _round(light: AreaLight, receiver: Plane) -> Field:
    shape = light.shape
    if isinstance(shape, geometry.Sphere):
        formula = emitters.sphere_light(shape, light.radiance, receiver)
        return Field(lambda x: formula)
    if isinstance(shape, geometry.Disk):
        formula = emitters.disk_light(shape, light.radiance, receiver)
        face = Plane(point(shape.normal), dot(point(shape.normal), point(shape.center)))
        return Field(lambda x: formula if face.height(x) > 0 else emitters.dark, (face,))
    raise CannotCertify(f"there is no formula for a {type(shape).__name__.lower()} light")


def _polygon(shape: geometry.Polygon, radiance: float, blockers: list[Shape], receiver: Plane) -> Field:
    """Lambert's formula for what the receiver sees of a polygon light above its horizon and past the blockers."""
    corners = tuple(point(corner) for corner in shape.vertices)
    face = planes.of(corners)
    above = clip(corners, receiver.normal, receiver.offset)
    between = tuple(filter(None, (_blocker(blocker, face, receiver) for blocker in blockers)))
    light = convex_parts(above) if above else ()
    normal = unit(receiver.normal)

    @cache
    def near(x: Point) -> Formula:
        if face.height(x) <= 0:
            return emitters.dark
        loops = visible(light, between, x)
        return lambda y: exact(radiance) * sum((count * lambert(loop, y, normal) for loop, count in loops.items()), arb(0))

    return Field(near, (face, *_events(light, between)) if len(between) < 2 else None)


def _blocker(shape: Shape, face: Plane, receiver: Plane) -> Parts:
    """The part of a blocker between the receiver's plane and the light's."""
    if not isinstance(shape, geometry.Polygon):
        raise CannotCertify(f"a {type(shape).__name__.lower()} stands before a polygon light; only polygon blockers are covered")
    corners = clip(tuple(point(corner) for corner in shape.vertices), receiver.normal, receiver.offset)
    corners = clip(corners, face.normal, face.offset) if corners else ()
    return convex_parts(corners) if corners else ()


def _events(light: Parts, blockers: tuple[Parts, ...]) -> Iterable[Plane]:
    """The planes in which a corner of the light is seen on an edge of the blocker, or the other way round, or the blocker is
    seen edge-on."""
    for _, corners in light:
        for _, shadow in (part for blocker in blockers for part in blocker):
            yield planes.of(shadow)
            for points, edges in ((corners, shadow), (shadow, corners)):
                yield from (planes.through(p, edges[i - 1], edges[i]) for p in points for i in range(len(edges)))


def mean_over(frame: Frame, lights: list[Field], region: Region) -> arb:
    """Mean irradiance over a convex region of a plane film. Raises CannotCertify."""
    if any(light.events is None for light in lights):
        raise CannotCertify("the shadows of several blockers may meet on the film, in curves that are not covered")
    lines = {line for light in lights for event in light.events if (line := frame.line(event))}
    total = sum((_flux(frame, lights, part) for part in planes.cut(region, sorted(lines))), arb(0))
    return total / planes.area(region)


def _flux(frame: Frame, lights: list[Field], region: Region) -> arb:
    """Integral over film positions of a region that no event crosses."""
    middle = frame.at(*planes.centre(region))
    formulas = [formula for light in lights if (formula := light.near(middle)) is not emitters.dark]
    if not formulas:
        return arb(0)
    return sum((_over(frame, formulas, patch) for patch in planes.patches(region)), arb(0))


def _over(frame: Frame, formulas: list[Formula], patch: Patch) -> arb:
    def integrand(s: Ball, t: Ball) -> Ball:
        x = frame.at(*patch.at(s, t))
        return patch.jacobian(s, t) * sum((formula(x) for formula in formulas), arb(0))

    return quadrature.integral(integrand)


def solve(scene_: Scene) -> Element:
    """The irradiance of a plane or points film, element by element. Raises CannotCertify."""
    if scene_.reflects:
        raise CannotCertify("light reflected between surfaces is covered inside one sphere only")
    film = scene_.film
    if isinstance(film, scene.PointsFilm):
        return lambda element: at_point(scene_, film.positions[element], film.normals[element])
    frame = Frame.of(film)
    lights = fields(scene_, frame.plane)
    return lambda element: mean_over(frame, lights, frame.cell(element))


def at_point(scene_: Scene, position: geometry.Vec3, normal: geometry.Vec3) -> arb:
    """Irradiance of one receiver. Raises CannotCertify."""
    x, n = point(position), point(normal)
    return sum((light.near(x)(x) for light in fields(scene_, Plane(n, dot(n, x)))), arb(0))
