"""Lights that nothing stands before: the closed forms of `emitters`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from lightproof import geometry, scene
from lightproof.certify import curved, emitters, parting, provenance, tube, walls
from lightproof.certify.balls import CannotCertify, Point
from lightproof.certify.emitters import Formula
from lightproof.certify.field import Field, Shape
from lightproof.certify.planes import Plane
from lightproof.certify.provenance import Provenance
from lightproof.scene import AreaLight

FORMULAS: dict[type, Callable[[scene.Light, Plane], Formula]] = {
    scene.PointLight: emitters.point_light,
    scene.DirectionalLight: emitters.beam,
    scene.Environment: emitters.uniform_sky,
    scene.OvercastSky: emitters.overcast_sky,
    scene.SunDisc: emitters.sun,
}
SOURCES: dict[type, Provenance] = {
    scene.PointLight: provenance.POINT,
    scene.DirectionalLight: provenance.BEAM,
    scene.Environment: provenance.SKY,
    scene.OvercastSky: provenance.OVERCAST,
    scene.SunDisc: provenance.SPHERE,
    geometry.Disk: provenance.DISK,
    geometry.Sphere: provenance.SPHERE,
    geometry.Cylinder: provenance.OUTLINES,
}


def covers(light: scene.Light, blockers: list[Shape]) -> bool:
    """Whether this module knows the light: any but a polygon, where nothing else stands above the receiver."""
    return not blockers and not (isinstance(light, AreaLight) and isinstance(light.shape, geometry.Polygon))


def provenance_of(light: scene.Light, blockers: list[Shape]) -> Provenance:
    """Where the light's formula comes from."""
    return SOURCES[type(light.shape if isinstance(light, AreaLight) else light)]


def field(light: scene.Light, blockers: list[Shape], receiver: Plane) -> Field:
    """The light's irradiance on a plane's front. Raises CannotCertify."""
    if isinstance(light, AreaLight):
        return _round(light, receiver)
    formula = FORMULAS[type(light)](light, receiver)
    return Field(lambda x: formula)


def _round(light: AreaLight, receiver: Plane) -> Field:
    shape = light.shape
    if isinstance(shape, geometry.Sphere):
        formula = emitters.sphere_light(shape, light.radiance, receiver)
        return Field(lambda x: formula)
    if not isinstance(shape, geometry.Disk | geometry.Cylinder):
        raise CannotCertify(f"there is no formula for a {type(shape).__name__.lower()} light")
    if parting.below(shape, receiver):
        return Field(lambda x: emitters.dark)
    if not parting.above(shape, receiver):
        return replace(curved.field(light, [], receiver), flux=None)
    return _disk(light, receiver) if isinstance(shape, geometry.Disk) else _tube(light, receiver)


def _disk(light: AreaLight, receiver: Plane) -> Field:
    formula, face = emitters.disk_light(light.shape, light.radiance, receiver), parting.face(light.shape)
    return Field(lambda x: formula if face.height(x) > 0 else emitters.dark, (face,))


def _tube(light: AreaLight, receiver: Plane) -> Field:
    formula = tube.tube_light(light.shape, light.radiance, receiver)

    def near(x: Point) -> Formula:
        return formula if walls.Wall.of(light.shape, x).reach > 0 else emitters.dark

    return Field(near)
