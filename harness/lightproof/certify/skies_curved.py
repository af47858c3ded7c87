"""Uniform skies and suns behind disks, spheres and cylinders, and behind polygons beside these: values at points.

Where a sphere stands alone in an open sky, films too: it hides what it would give as a light.
"""

from __future__ import annotations

from collections.abc import Callable

from flint import arb, fmpq

from lightproof import geometry, scene
from lightproof.certify import emitters, flux, outlines, parting, provenance, skies
from lightproof.certify.arrangement import EVERYTHING, Outline, irradiance, visible
from lightproof.certify.balls import CannotCertify, Point, dot, exact, point, times, unit
from lightproof.certify.circles import Rim
from lightproof.certify.emitters import Formula
from lightproof.certify.field import Field, Shape
from lightproof.certify.planes import Frame, Plane, Region
from lightproof.certify.provenance import Provenance

Flux = Callable[[Frame, Region], arb]


def covers(light: scene.Light, blockers: list[Shape]) -> bool:
    """Whether this is a sky or a sun with something curved in front of it."""
    return isinstance(light, skies.Sky) and any(not isinstance(blocker, geometry.Polygon) for blocker in blockers)


def provenance_of(light: skies.Sky, blockers: list[Shape]) -> Provenance:
    """Where the formula comes from."""
    return provenance.OUTLINES


def field(light: skies.Sky, blockers: list[Shape], receiver: Plane) -> Field:
    """The contour integral around what is seen of the sky. Raises CannotCertify."""
    if isinstance(light, scene.OvercastSky):
        raise CannotCertify(f"something curved stands before '{light.id}'; only polygons are covered before an overcast sky")
    above = [shape for shape in map(parting.solid, blockers) if not parting.below(shape, receiver)]
    normal, upper = unit(receiver.normal), outlines.half(receiver.normal)

    def near(x: Point) -> Formula:
        seen = visible(_outline(light), upper, [outlines.seen(shape, x) for shape in above])
        return lambda y: exact(light.radiance) * irradiance(seen, normal)

    if len(above) == 1 and isinstance(above[0], geometry.Sphere) and _is_uniform(light, receiver):
        return Field(near, None, _beside_sphere(light, above[0], receiver))
    return Field(near, None, skies.refusal(f"means under '{light.id}' behind something curved are not covered; points are"))


def _is_uniform(light: skies.Sky, receiver: Plane) -> bool:
    return isinstance(light, scene.Environment) and skies.is_level(light, receiver)


def _beside_sphere(light: scene.Environment, sphere: geometry.Sphere, receiver: Plane) -> Flux:
    """The flux of an open sky less that of the sphere, as if it were a light."""
    whole, hidden = emitters.uniform_sky(light, receiver), emitters.sphere_light(sphere, light.radiance, receiver)
    return lambda frame, region: flux.through(frame, region, lambda y: whole(y) - hidden(y))


def _outline(light: scene.Environment | scene.SunDisc) -> Outline:
    """The directions that are bright, where nothing is in front."""
    if isinstance(light, scene.Environment):
        return EVERYTHING if light.extent == "sphere" else outlines.half(skies.UP)
    axis = times(point(light.direction), -1)
    if light.half_angle == 90:
        return outlines.half(axis)
    share = (arb.pi() * exact(light.half_angle) / 180).cos() ** 2
    rim = Rim((fmpq(0),) * 3, axis, dot(axis, axis) * share, dot(axis, axis) * share * (1 - share))
    return Outline((rim,), lambda side: side(rim))
