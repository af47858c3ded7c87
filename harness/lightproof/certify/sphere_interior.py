"""Inside one diffuse sphere, whole or of two zones: a wall that glows, and point lights."""

from __future__ import annotations

from flint import arb

from lightproof import geometry
from lightproof.certify import emitters, provenance, sphere_seen, spheres
from lightproof.certify.balls import CannotCertify, Element, dot, plus, point
from lightproof.certify.integrating_sphere import from_wall, uniform
from lightproof.certify.planes import Plane
from lightproof.certify.provenance import Provenance
from lightproof.scene import CameraFilm, PointLight, PointsFilm, Scene

ZONES = Provenance(
    "E = D(x) + E_w, E_w = π ⟨L_e⟩ + ⟨ρ D⟩ + ⟨ρ⟩ E_w, in brackets means over the wall, D = I cos θ/d² straight from point lights;"
    " L = L_e + ρ E/π",
    provenance.SPHERE_THEOREM,
    ("jacquez1955",),
)


def covers(scene: Scene) -> bool:
    """Whether everything happens inside one sphere."""
    zones = [surface.shape for surface in scene.surfaces if surface.side == "inside"]
    if scene.film.quantity == "solid_angle" or len(zones) != len(scene.surfaces):
        return False
    if all(isinstance(zone, geometry.Cap) for zone in zones):
        return len(zones) == 2 and zones[0].completes(zones[1])
    return len(zones) == 1 and isinstance(zones[0], geometry.Sphere)


def kind(scene: Scene) -> str:
    """Closed forms, and means of them."""
    return "enclosure"


def provenance_of(scene: Scene) -> Provenance:
    """Where the formula comes from."""
    if len(scene.surfaces) > 1:
        return ZONES
    return provenance.LIT_SPHERE if scene.lights else provenance.GLOW


def solve(scene: Scene) -> Element:
    """Radiance of the wall, or irradiance inside. Raises CannotCertify."""
    if any(not isinstance(light, PointLight) for light in scene.lights):
        raise CannotCertify("inside a sphere, walls that glow and point lights are covered")
    spheres.check_within(scene.surfaces[0].shape, (point(light.position) for light in scene.lights))
    if isinstance(scene.film, CameraFilm):
        return sphere_seen.solve(scene)
    return _received(scene) if isinstance(scene.film, PointsFilm) else _crossed(scene)


def _received(scene: Scene) -> Element:
    """At points of the wall that face the centre, or at others inside where the wall looks the same everywhere."""
    wall, film = scene.surfaces[0].shape, scene.film
    on = [spheres.is_on(wall, position) for position in film.positions]
    for position, normal, on_wall in zip(film.positions, film.normals, on, strict=True):
        if on_wall:
            spheres.check_faces(wall, position, normal, inward=True)
        else:
            spheres.check_within(wall, [point(position)])
    at_wall, elsewhere = from_wall(scene, scene.max_bounces), None if all(on) else arb.pi() * uniform(scene)
    return lambda element: _direct(scene, element) + (at_wall if on[element] else elsewhere)


def _direct(scene: Scene, element: int) -> arb:
    """Irradiance of a point from the point lights alone."""
    x, normal = point(scene.film.positions[element]), point(scene.film.normals[element])
    receiver = Plane(normal, dot(normal, x))
    return sum((arb(emitters.point_light(light, receiver)(x)) for light in scene.lights), arb(0))


def _crossed(scene: Scene) -> Element:
    """On a plane inside, where the wall looks the same everywhere."""
    if scene.lights:
        raise CannotCertify("a plane film inside a sphere is covered where the wall alone shines")
    corner, u, v = point(scene.film.origin), point(scene.film.u), point(scene.film.v)
    spheres.check_within(scene.surfaces[0].shape, (corner, plus(corner, u), plus(corner, v), plus(corner, plus(u, v))))
    value = arb.pi() * uniform(scene)
    return lambda element: value
