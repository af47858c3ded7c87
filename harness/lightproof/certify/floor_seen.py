"""A camera that sees nothing but a lit, diffuse floor: radiance rho E / pi, averaged over each pixel's square."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from flint import arb

from lightproof import geometry, scene
from lightproof.certify import direct, planes, provenance, quadrature
from lightproof.certify.balls import Ball, CannotCertify, Element, Point, Vector, cross, dot, exact, minus, plus, point, times
from lightproof.certify.camera import Camera
from lightproof.certify.emitters import Formula
from lightproof.certify.field import Field
from lightproof.certify.planes import Plane
from lightproof.certify.provenance import Provenance
from lightproof.scene import Scene

Ray = tuple[Vector, Vector]  # origin and direction


def covers(scene_: Scene) -> bool:
    """Whether the film is a camera."""
    return isinstance(scene_.film, scene.CameraFilm)


def kind(scene_: Scene) -> str:
    """Means of closed forms, by rules whose error is proven."""
    return "enclosure"


def provenance_of(scene_: Scene) -> Provenance:
    """That of the light on the floor, seen."""
    parts = [direct.provenance_of(replace(scene_, surfaces=()))]
    return provenance.joined(parts, "; L = ρ E/π, averaged over each pixel")


def solve(scene_: Scene) -> Element:
    """Mean radiance of each pixel. Raises CannotCertify."""
    floor = _floor(scene_)
    corners = [point(corner) for corner in floor.shape.vertices]
    plane = planes.of(corners)
    if floor.radiance > 0:
        raise CannotCertify(f"surface '{floor.id}' emits light of its own; only a floor that reflects is covered")
    camera = Camera.of(scene_.film)
    lights = direct.fields(replace(scene_, surfaces=()), plane) if scene_.max_bounces != 0 else []
    factor = exact(floor.reflectance) / arb.pi()

    def element(index: int) -> arb:
        def hit(s: Ball, t: Ball) -> Vector:
            return _hit(camera.ray(index, s, t), plane)

        rays = [camera.ray(index, arb(s), arb(t)) for s in (-1, 1) for t in (-1, 1)]
        _check_lights(scene_, plane, [plane.height(start) for start, _ in rays])
        _check_pixel(rays, plane, corners)
        formulas = _formulas(lights, hit)
        return quadrature.mean(lambda s, t: factor * sum((formula(x) for formula in formulas for x in [hit(s, t)]), arb(0)))

    return element


def _floor(scene_: Scene) -> scene.Surface:
    if len(scene_.surfaces) != 1 or not isinstance(scene_.surfaces[0].shape, geometry.Polygon):
        raise CannotCertify("a camera is covered where it looks at one polygon, or from inside a sphere")
    return scene_.surfaces[0]


def _check_lights(scene_: Scene, floor: Plane, starts: list[Ball]) -> None:
    """No ray that goes down to the floor from one of these heights can meet a light that is nowhere lower."""
    if not all(start > 0 for start in starts):
        raise CannotCertify("the camera is behind the floor")
    for light in scene_.lights:
        if isinstance(light, scene.AreaLight):
            shape = light.shape
            corners = [point(corner) for corner in shape.vertices] if isinstance(shape, geometry.Polygon) else []
            if not corners or not all(start <= floor.height(corner) for corner in corners for start in starts):
                raise CannotCertify(f"light '{light.id}' may stand between the camera and the floor")


def _hit(ray: Ray, floor: Plane) -> Vector:
    """Where a ray meets the floor's plane."""
    origin, along = ray
    return plus(origin, times(along, -floor.height(origin) / dot(floor.normal, along)))


def _check_pixel(rays: list[Ray], floor: Plane, corners: list[Point]) -> None:
    """All four corner rays go down and meet the floor on the inner side of each of its edges."""
    for ray in rays:
        below = dot(floor.normal, ray[1]) < 0
        for start, end in zip(corners, (*corners[1:], corners[0]), strict=True):
            if not (below and dot(floor.normal, cross(minus(end, start), minus(_hit(ray, floor), start))) > 0):
                raise CannotCertify("a pixel sees past the floor")


def _formulas(lights: list[Field], hit: Callable[[Ball, Ball], Vector]) -> list[Formula]:
    """The lights' formulas, which must hold over the whole pixel."""
    whole = hit(arb(0, 1), arb(0, 1))
    middle = tuple(exact(float(component)) for component in hit(arb(0), arb(0)))
    for light in lights:
        if light.events is None or any(event.height(whole).contains(0) for event in light.events):
            raise CannotCertify("a shadow's edge crosses a pixel")
    return [light.near(middle) for light in lights]


