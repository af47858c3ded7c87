"""Light that beams throw on flat surfaces and those reflect once: each lit surface is a lamp of radiance rho E / pi."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import ModuleType

from flint import arb

from lightproof import geometry
from lightproof.certify import direct, emitters, perpendicular, planes, provenance
from lightproof.certify.balls import CannotCertify, Element, Point, cross, dot, exact, point
from lightproof.certify.provenance import Provenance
from lightproof.scene import AreaLight, CameraFilm, DirectionalLight, PlaneFilm, Scene, Surface

FORMULA = Provenance(
    "L = ρ E/π of a surface under E = E₀ cos θ",
    "A Lambertian surface reflects the exitance ρ E.",
    ("lambert1760",),
)


def covers(scene: Scene) -> bool:
    """Whether all light is that of beams, and some of it is reflected on its way to a film that receives."""
    beams = bool(scene.lights) and all(isinstance(light, DirectionalLight) for light in scene.lights)
    return beams and scene.reflects and not isinstance(scene.film, CameraFilm) and scene.film.quantity == "irradiance"


def kind(scene: Scene) -> str:
    """An enclosure where the light that each reflecting surface gives is one."""
    kinds = {_module(lamp).kind(lamp) for lamp in _lamps(scene)}
    return "enclosure" if kinds == {"enclosure"} else "quadrature"


def provenance_of(scene: Scene) -> Provenance:
    """That of polygon lights, their radiance explained."""
    return provenance.joined([FORMULA, *(_module(lamp).provenance_of(lamp) for lamp in _lamps(scene))])


def solve(scene: Scene) -> Element:
    """What beams give the film straight, and what each lit surface gives it. Raises CannotCertify."""
    reflecting = [surface for surface in scene.surfaces if surface.reflectance > 0]
    _check(scene, reflecting)
    exitance = [(exact(surface.reflectance) * _irradiance(scene, surface), surface) for surface in reflecting]
    lit = [(value / arb.pi(), _under(scene, surface)) for value, surface in exitance if not value.is_zero()]
    lamps = [(radiance, _module(lamp).solve(lamp)) for radiance, lamp in lit]
    straight = [direct.solve(replace(scene, lights=(beam,), max_bounces=0)) for beam in scene.lights if _reaches(beam, scene)]
    return lambda element: (sum((radiance * lamp(element) for radiance, lamp in lamps), arb(0))
                            + sum((beam(element) for beam in straight), arb(0)))


def _check(scene: Scene, reflecting: Sequence[Surface]) -> None:
    """Only polygons reflect, nothing glows, and no light is reflected twice on its way. Raises CannotCertify."""
    for surface in scene.surfaces:
        if surface.radiance > 0:
            raise CannotCertify(f"surface '{surface.id}' emits light of its own; give it as an area light")
    for surface in reflecting:
        if not isinstance(surface.shape, geometry.Polygon):
            raise CannotCertify(f"'{surface.id}' reflects and is no polygon; light that polygons reflect is covered")
    for a in reflecting if scene.max_bounces != 1 else ():
        for b in reflecting:
            if _is_above(a, b) and _is_above(b, a):
                raise CannotCertify(f"light may be reflected between '{a.id}' and '{b.id}'; one reflection is covered")


def _is_above(a: Surface, b: Surface) -> bool:
    """Whether any of the polygon a is in front of b."""
    plane = planes.of(_corners(b.shape))
    return any(plane.height(corner) > 0 for corner in _corners(a.shape))


def _corners(shape: geometry.Polygon) -> list[Point]:
    return [point(corner) for corner in shape.vertices]


def _irradiance(scene: Scene, surface: Surface) -> arb:
    """Of a polygon in the beams' light, the same all over it [W/m2]. Raises CannotCertify where something may shade it."""
    corners = _corners(surface.shape)
    plane = planes.of(corners)
    lit = [beam for beam in scene.lights if dot(point(beam.direction), plane.normal) < 0]
    for beam in lit:
        for other in scene.surfaces:
            if other is not surface and not _passes(point(beam.direction), corners, other.shape):
                raise CannotCertify(f"'{other.id}' may shade '{surface.id}' from '{beam.id}'; evenly lit surfaces are covered")
    return sum((emitters.beam(beam, plane)(corners[0]) for beam in lit), arb(0))


def _passes(direction: Point, corners: Sequence[Point], shape: geometry.Shape) -> bool:
    """Whether a shape keeps clear of the light on its way to a polygon: the beam runs along it, or it is behind the polygon, or
    a plane along the beam parts them."""
    if not isinstance(shape, geometry.Polygon):
        return False
    others = _corners(shape)
    if dot(planes.of(others).normal, direction) == 0:
        return True
    if max(planes.of(corners).height(corner) for corner in others) <= 0:
        return True
    edges = [(loop[i - 1], loop[i]) for loop in (corners, others) for i in range(len(loop))]
    axes = [cross(direction, tuple(b - a for a, b in zip(*edge, strict=True))) for edge in edges]
    return any(_parts(axis, corners, others) or _parts(axis, others, corners) for axis in axes if any(axis))


def _parts(axis: Point, low: Sequence[Point], high: Sequence[Point]) -> bool:
    """Whether no point of one polygon is further along an axis than any of another."""
    return max(dot(axis, corner) for corner in low) <= min(dot(axis, corner) for corner in high)


def _lamps(scene: Scene) -> list[Scene]:
    """The scene lit by each of its reflecting surfaces in turn."""
    return [_under(scene, surface) for surface in scene.surfaces if surface.reflectance > 0]


def _under(scene: Scene, surface: Surface) -> Scene:
    """The scene lit by one of its surfaces alone, of radiance 1, where nothing reflects."""
    lamp = AreaLight(surface.id, surface.shape, 1.0)
    rest = tuple(replace(other, reflectance=0.0) for other in scene.surfaces if other is not surface)
    return replace(scene, lights=(lamp,), surfaces=rest, max_bounces=0)


def _module(scene: Scene) -> ModuleType:
    """What knows the light of a lit surface."""
    return perpendicular if perpendicular.covers(scene) else direct


def _reaches(beam: DirectionalLight, scene: Scene) -> bool:
    """Whether any receiver of the film faces a beam."""
    film = scene.film
    normals = [cross(point(film.u), point(film.v))] if isinstance(film, PlaneFilm) else map(point, film.normals)
    return any(dot(point(beam.direction), normal) < 0 for normal in normals)
