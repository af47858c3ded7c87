"""Inside a diffuse sphere, where the form factor to an area dA is dA / (4 pi R^2) from everywhere: reflected light is uniform."""

from __future__ import annotations

from collections.abc import Callable

from flint import arb

from lightproof import geometry, scene
from lightproof.certify import emitters, provenance, quadrature
from lightproof.certify.balls import Ball, CannotCertify, Element, Vector, cross, dot, exact, minus, plus, point, root, times
from lightproof.certify.camera import Camera
from lightproof.certify.planes import Plane
from lightproof.certify.provenance import Provenance
from lightproof.scene import Scene

ROUNDING = exact(1e-15)  # of the radius: how far the binary64 position of a point of the wall may lie off it


def covers(scene_: Scene) -> bool:
    """Whether everything happens inside one sphere."""
    return [(type(surface.shape), surface.side) for surface in scene_.surfaces] == [(geometry.Sphere, "inside")]


def kind(scene_: Scene) -> str:
    """Closed forms, and means of them."""
    return "enclosure"


def provenance_of(scene_: Scene) -> Provenance:
    """Where the formula comes from."""
    return provenance.LIT_SPHERE if scene_.lights else provenance.GLOW


def solve(scene_: Scene) -> Element:
    """Radiance of the wall, or irradiance on it, from a wall that glows or a point light. Raises CannotCertify."""
    wall, film = scene_.surfaces[0], scene_.film
    lights = scene_.lights
    if len(lights) + (wall.radiance > 0) != 1 or any(not isinstance(light, scene.PointLight) for light in lights):
        raise CannotCertify("inside a sphere, either the wall glows or there is one point light")
    if isinstance(film, scene.PlaneFilm) or (isinstance(film, scene.CameraFilm) and film.projection == "orthographic"):
        raise CannotCertify("inside a sphere, a perspective camera or points on the wall are covered")
    inside = [light.position for light in lights]
    if isinstance(film, scene.PointsFilm):
        _check_on_wall(wall.shape, film)
    else:
        inside.append(film.origin)
    _check_inside(wall.shape, inside)
    return _lit(scene_, wall, lights[0]) if lights else _glowing(scene_, wall)


def _check_inside(sphere: geometry.Sphere, positions: list[geometry.Vec3]) -> None:
    for position in positions:
        ray = minus(point(position), point(sphere.center))
        if dot(ray, ray) >= exact(sphere.radius) ** 2:
            raise CannotCertify(f"{list(position)} does not lie inside the sphere")


def _check_on_wall(sphere: geometry.Sphere, film: scene.PointsFilm) -> None:
    """Each point lies on the wall and faces the centre, but for rounding."""
    radius = exact(sphere.radius)
    for position, normal in zip(film.positions, film.normals, strict=True):
        ray, n = minus(point(sphere.center), point(position)), point(normal)
        aside = cross(ray, n)
        off = abs(dot(ray, ray) - radius**2) > 2 * ROUNDING * radius**2
        if off or dot(ray, n) <= 0 or dot(aside, aside) > ROUNDING**2 * dot(ray, ray) * dot(n, n):
            raise CannotCertify(f"{list(position)} is no point of the wall that faces the centre")


def _glowing(scene_: Scene, wall: scene.Surface) -> Element:
    """L = L_e (1 + rho + rho^2 + ...) everywhere, E = pi L."""
    radiance = exact(wall.radiance) * _series(wall.reflectance, 0, scene_.max_bounces)
    value = arb(radiance) if scene_.film.quantity == "radiance" else arb.pi() * radiance
    return lambda element: value


def _series(reflectance: float, first: int, last: int | str) -> arb:
    """The sum of reflectance^k for k from `first` to `last`, or to infinity where `last` is "all"."""
    rho = exact(reflectance)
    if last == "all":
        return arb(rho) ** first / (1 - rho)
    return sum((arb(rho) ** k for k in range(first, last + 1)), arb(0))


def _lit(scene_: Scene, wall: scene.Surface, light: scene.PointLight) -> Element:
    """A point light's own irradiance, and I / R^2 (rho + rho^2 + ...) of reflected light from everywhere."""
    film, last = scene_.film, scene_.max_bounces
    spread = exact(light.intensity) / exact(wall.shape.radius) ** 2
    if isinstance(film, scene.PointsFilm):
        return lambda element: _direct(light, film, element) + spread * _series(wall.reflectance, 1, last)
    if last == 0:
        return lambda element: arb(0)
    before = spread * _series(wall.reflectance, 1, last if last == "all" else last - 1)
    camera, centre, radius = Camera.of(film), point(wall.shape.center), exact(wall.shape.radius)
    radiance = _seen(light, centre, radius, before, exact(wall.reflectance))
    return lambda element: quadrature.mean(lambda s, t: radiance(_exit(*camera.within(element, s, t), centre, radius)))


def _direct(light: scene.PointLight, film: scene.PointsFilm, element: int) -> arb:
    x, normal = point(film.positions[element]), point(film.normals[element])
    return arb(emitters.point_light(light, Plane(normal, dot(normal, x)))(x))


def _seen(light: scene.PointLight, centre: Vector, radius: Ball, before: Ball, rho: Ball) -> Callable[[Vector], Ball]:
    """Radiance of the wall at x: rho / pi times its irradiance."""

    def radiance(x: Vector) -> Ball:
        ray = minus(point(light.position), x)
        squared, cosine = dot(ray, ray), dot(ray, minus(centre, x)) / radius
        return rho / arb.pi() * (exact(light.intensity) * cosine / (squared * root(squared)) + before)

    return radiance


def _exit(origin: Vector, direction: Vector, centre: Vector, radius: Ball) -> Vector:
    """Where a ray from inside meets the sphere."""
    to_centre = minus(centre, origin)
    along, squared = dot(to_centre, direction), dot(direction, direction)
    inside = radius * radius - dot(to_centre, to_centre)
    return plus(origin, times(direction, (along + root(along * along + squared * inside)) / squared))
