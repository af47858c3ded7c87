"""Polygon lights behind polygon blockers: Lambert's formula on what the receiver sees."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

from flint import arb

from lightproof import geometry, scene
from lightproof.certify import emitters, planes, provenance
from lightproof.certify.balls import CannotCertify, Point, exact, point, unit
from lightproof.certify.emitters import Formula
from lightproof.certify.field import Field, Shape
from lightproof.certify.planes import Plane
from lightproof.certify.polygon import Parts, clip, convex_parts, lambert, visible
from lightproof.certify.provenance import Provenance
from lightproof.scene import AreaLight


def covers(light: scene.Light, blockers: list[Shape]) -> bool:
    """Whether this module knows the light behind these blockers."""
    return isinstance(light, AreaLight) and isinstance(light.shape, geometry.Polygon)


def provenance_of(light: AreaLight, blockers: list[Shape]) -> Provenance:
    """Where the formula comes from."""
    return provenance.SHADOW if blockers else provenance.POLYGON


def field(light: AreaLight, blockers: list[Shape], receiver: Plane) -> Field:
    """Lambert's formula for what the receiver sees of a polygon light above its horizon and past the blockers."""
    corners = tuple(point(corner) for corner in light.shape.vertices)
    face = planes.of(corners)
    above = clip(corners, receiver.normal, receiver.offset)
    between = tuple(filter(None, (_blocker(blocker, face, receiver) for blocker in blockers)))
    parts = convex_parts(above) if above else ()
    normal = unit(receiver.normal)

    @cache
    def near(x: Point) -> Formula:
        if face.height(x) <= 0:
            return emitters.dark
        loops = visible(parts, between, x)
        return lambda y: exact(light.radiance) * sum((count * lambert(loop, y, normal) for loop, count in loops.items()), arb(0))

    return Field(near, (face, *_events(parts, between)) if len(between) < 2 else None)


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
