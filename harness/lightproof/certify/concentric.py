"""Between two concentric diffuse spheres: each radiates alike all over, so that two numbers tell everything."""

from __future__ import annotations

from flint import arb, arb_mat

from lightproof import geometry
from lightproof.certify import cones, series, spheres
from lightproof.certify.balls import CannotCertify, Element, exact, point
from lightproof.certify.camera import Camera
from lightproof.certify.provenance import Provenance
from lightproof.scene import CameraFilm, PointsFilm, Scene, Surface

FORMULA = Provenance(
    "E₁ = B₂, E₂ = k B₁ + (1 − k) B₂, Bᵢ = π Lᵢ + ρᵢ Eᵢ, k = (r₁/r₂)²",
    "View factors between concentric spheres: the inner sees nothing but the outer, which sees k of the inner and else itself.",
    ("howell",),
)


def covers(scene: Scene) -> bool:
    """Whether there are two spheres with one centre, one facing out, one facing in."""
    shapes = [surface.shape for surface in scene.surfaces]
    if len(shapes) != 2 or scene.film.quantity == "solid_angle" or not all(isinstance(s, geometry.Sphere) for s in shapes):
        return False
    return {surface.side for surface in scene.surfaces} == {"inside", "outside"} and shapes[0].center == shapes[1].center


def kind(scene: Scene) -> str:
    """Closed forms, and means of them."""
    return "enclosure"


def provenance_of(scene: Scene) -> Provenance:
    """Where the formula comes from."""
    return FORMULA


def solve(scene: Scene) -> Element:
    """Irradiance on either sphere, or what a camera between them sees. Raises CannotCertify."""
    inner, outer = sorted(scene.surfaces, key=lambda surface: surface.side, reverse=True)
    if scene.lights or not inner.shape.radius < outer.shape.radius:
        raise CannotCertify("between concentric spheres, the light of the spheres themselves is covered, the inner facing out")
    if isinstance(scene.film, CameraFilm):
        return _seen(scene, inner, outer)
    if not isinstance(scene.film, PointsFilm):
        raise CannotCertify("between concentric spheres, points of the spheres and perspective cameras are covered")
    return _received(scene, inner, outer)


def irradiance(inner: Surface, outer: Surface, last: int | str) -> tuple[arb, arb]:
    """On the inner and on the outer sphere after up to `last` reflections [W/m2]."""
    k = (exact(inner.shape.radius) / exact(outer.shape.radius)) ** 2
    seen = arb_mat([[0, 1], [k, 1 - k]])
    kept = arb_mat([[exact(inner.reflectance), 0], [0, exact(outer.reflectance)]])
    own = arb_mat([[arb.pi() * exact(inner.radiance)], [arb.pi() * exact(outer.radiance)]])
    values = series.total(seen * kept, seen * own, last)
    return values[0, 0], values[1, 0]


def _received(scene: Scene, inner: Surface, outer: Surface) -> Element:
    """Irradiance at points of either sphere that face straight away from it."""
    film = scene.film
    on = [spheres.is_on(inner.shape, position) for position in film.positions]
    for position, normal, on_inner in zip(film.positions, film.normals, on, strict=True):
        if not on_inner and not spheres.is_on(outer.shape, position):
            raise CannotCertify(f"{list(position)} lies on neither sphere")
        spheres.check_faces(inner.shape, position, normal, inward=not on_inner)
    at_inner, at_outer = irradiance(inner, outer, scene.max_bounces)
    return lambda element: at_inner if on[element] else at_outer


def _seen(scene: Scene, inner: Surface, outer: Surface) -> Element:
    """Mean radiance of each pixel: the spheres' by the part of it that each fills."""
    if scene.film.projection == "orthographic":
        raise CannotCertify("between concentric spheres, a perspective camera is covered")
    camera = Camera.of(scene.film)
    spheres.check_within(outer.shape, [camera.origin])
    spheres.check_outside(inner.shape, [camera.origin])
    cone = cones.around_sphere(camera.origin, point(inner.shape.center), exact(inner.shape.radius))
    received = irradiance(inner, outer, series.before(scene.max_bounces))
    near, far = (series.leaving(sphere, value, scene.max_bounces) for sphere, value in zip((inner, outer), received, strict=True))
    return lambda index: far + (near - far) * cones.share(camera, index, cone)
