"""What a camera sees from inside a diffuse sphere: the mean radiance of each pixel."""

from __future__ import annotations

from collections.abc import Callable

from flint import arb

from lightproof import geometry
from lightproof.certify import cones, quadrature, series, spheres
from lightproof.certify.balls import (
    Ball,
    CannotCertify,
    Element,
    Number,
    Undecided,
    Vector,
    dot,
    exact,
    minus,
    plus,
    point,
    root,
    times,
    unit,
)
from lightproof.certify.camera import Camera
from lightproof.certify.cones import Cone
from lightproof.certify.integrating_sphere import evenly, from_wall, is_central
from lightproof.scene import PointLight, Scene


def solve(scene: Scene) -> Element:
    """Each zone's radiance by its share of the pixel, and what lights off the centre add. Raises CannotCertify."""
    if scene.film.projection == "orthographic":
        raise CannotCertify("inside a sphere, a perspective camera is covered")
    spheres.check_within(scene.surfaces[0].shape, [point(scene.film.origin)])
    camera, last = Camera.of(scene.film), scene.max_bounces
    even = evenly(filter(lambda light: is_central(light, scene), scene.lights), scene)
    zones = [series.leaving(zone, even + from_wall(scene, series.before(last)), last) for zone in scene.surfaces]
    aside = [_reflected(light, scene) for light in scene.lights if last != 0 and not is_central(light, scene)]
    shares = _shares(scene, camera)

    def element(index: int) -> arb:
        mixed = sum((share * zone for share, zone in zip(shares(index), zones, strict=True)), arb(0))
        return mixed + sum((_mean(scene, camera, index, radiance) for radiance in aside), arb(0))

    return element


def _shares(scene: Scene, camera: Camera) -> Callable[[int], list[arb]]:
    """The part of a pixel that each zone fills."""
    if len(scene.surfaces) == 1:
        return lambda index: [arb(1)]
    (first, near), (second, far) = ((_rim(zone.shape, camera.origin)) for zone in scene.surfaces)
    if near == far:
        raise Undecided("the camera is in the plane that parts the zones")
    if near:
        return lambda index: [1 - (share := cones.share(camera, index, second)), share]
    return lambda index: [share := cones.share(camera, index, first), 1 - share]


def _rim(cap: geometry.Cap, eye: Vector) -> tuple[Cone, bool]:
    """The rays that leave through the disk that closes a cap, and whether the eye is on the cap's side of it."""
    axis, angle = unit(point(cap.axis)), arb.pi() * exact(cap.half_angle) / 180
    centre = plus(point(cap.center), times(axis, exact(cap.radius) * angle.cos()))
    cone = cones.through_disk(eye, centre, axis, exact(cap.radius) * angle.sin())
    return cone, bool(dot(minus(eye, centre), axis) > 0)


def _reflected(light: PointLight, scene: Scene) -> Callable[[Vector], Ball]:
    """Radiance of the wall at x after one reflection of a point light: rho / pi times its irradiance."""
    centre, radius = point(scene.surfaces[0].shape.center), exact(scene.surfaces[0].shape.radius)
    factor = exact(scene.surfaces[0].reflectance) * exact(light.intensity) / (arb.pi() * radius)

    def radiance(x: Vector) -> Ball:
        ray = minus(point(light.position), x)
        squared = dot(ray, ray)
        return factor * dot(ray, minus(centre, x)) / (squared * root(squared))

    return radiance


def _mean(scene: Scene, camera: Camera, index: int, radiance: Callable[[Vector], Ball]) -> arb:
    """Mean of a radiance of the wall over a pixel."""
    centre, radius = point(scene.surfaces[0].shape.center), exact(scene.surfaces[0].shape.radius)
    return quadrature.mean(lambda s, t: radiance(_exit(*camera.within(index, s, t), centre, radius)))


def _exit(origin: Vector, direction: Vector, centre: Vector, radius: Number) -> Vector:
    """Where a ray from inside meets the sphere."""
    to_centre = minus(centre, origin)
    along, squared = dot(to_centre, direction), dot(direction, direction)
    inside = radius * radius - dot(to_centre, to_centre)
    return plus(origin, times(direction, (along + root(along * along + squared * inside)) / squared))
