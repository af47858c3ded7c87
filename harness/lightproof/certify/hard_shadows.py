"""Point lights and beams behind blockers: all of the light, or none.

Over a plane film the edges of a shadow are straight behind polygons: they lie in the planes through the light and the
blockers' edges, along which what is lit is cut out exactly.
"""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb

from lightproof import geometry, scene
from lightproof.certify import emitters, flux, planes, provenance, rays
from lightproof.certify.balls import CannotCertify, Number, Point, cross, dot, minus, point, times
from lightproof.certify.emitters import Formula
from lightproof.certify.field import Field, Shape
from lightproof.certify.planes import Frame, Plane, Region
from lightproof.certify.provenance import Provenance
from lightproof.certify.shadows import above
from lightproof.certify.sightlines import Convex, edges

Light = scene.PointLight | scene.DirectionalLight


def covers(light: scene.Light, blockers: list[Shape]) -> bool:
    """Whether this module knows the light behind these blockers."""
    return isinstance(light, Light) and bool(blockers)


def provenance_of(light: Light, blockers: list[Shape]) -> Provenance:
    """Where the formula comes from."""
    return provenance.POINT_SHADOW if isinstance(light, scene.PointLight) else provenance.BEAM_SHADOW


def field(light: Light, blockers: list[Shape], receiver: Plane) -> Field:
    """The light's irradiance where nothing stands in its way. Raises CannotCertify."""
    if isinstance(light, scene.PointLight) and any(rays.lies_on(blocker, point(light.position)) for blocker in blockers):
        raise CannotCertify(f"light '{light.id}' lies on what stands before it: it has no light of its own side")
    formula = (emitters.point_light if isinstance(light, scene.PointLight) else emitters.beam)(light, receiver)

    def near(x: Point) -> Formula:
        ray, last = _way(light, x)
        return emitters.dark if any(rays.blocked(blocker, x, ray, last) for blocker in blockers) else formula

    def through(frame: Frame, region: Region) -> arb:
        x = frame.at(*planes.inside(region))
        scale = abs(formula(x)) * planes.area(region)
        lit = [region] if formula is not emitters.dark else []
        for shadow in _shadows(light, blockers, receiver):
            lit = [part for whole in lit for part in _outside(frame, whole, shadow)]
        return sum((flux.through(frame, part, formula, scale) for part in lit), arb(0))

    return Field(near, None, through)


def _way(light: Light, x: Point) -> tuple[Point, Number | None]:
    """The ray from a receiver towards the light, and how far the light is along it; None where it is endlessly far."""
    if isinstance(light, scene.PointLight):
        return minus(point(light.position), x), 1
    return times(point(light.direction), -1), None


def _shadows(light: Light, blockers: Sequence[Shape], receiver: Plane) -> list[list[Plane]]:
    """For each convex part of the blockers the planes all of which have its shadow on the receiver's plane in front."""
    parts = [part for blocker in blockers for part in above(_polygon(blocker, light), receiver)]
    return [sides for part in parts if (sides := _sides(light, part))]


def _polygon(shape: Shape, light: Light) -> geometry.Polygon:
    if not isinstance(shape, geometry.Polygon):
        raise CannotCertify(f"a {type(shape).__name__.lower()} stands before light '{light.id}': its shadow's edge is"
                            " curved, which is covered at points only")
    return shape


def _sides(light: Light, part: Convex) -> list[Plane]:
    """The planes through the light and the edges of a part; none where the light sees it edge-on."""
    found = []
    for start, end in edges(part):
        ray, _ = _way(light, start)
        normal = cross(minus(end, start), ray)
        side = Plane(normal, dot(normal, start))
        found.append(side if all(side.height(corner) >= 0 for corner in part) else side.turned)
    return found if any(side.height(corner) for side in found for corner in part) else []


def _outside(frame: Frame, region: Region, sides: Sequence[Plane]) -> list[Region]:
    """Convex regions that tile what of a region is not in front of all planes."""
    corners = [frame.at(*corner) for corner in region]
    if any(all(side.height(corner) <= 0 for corner in corners) for side in sides):
        return [region]
    rest, inner = [], [region]
    for side in sides:
        rest += [part for whole in inner for part in planes.in_front(frame, whole, side.turned)]
        inner = [part for whole in inner for part in planes.in_front(frame, whole, side)]
    return rest
