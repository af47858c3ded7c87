"""Polygon lights behind polygon blockers: Lambert's formula on what the receiver sees."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

from flint import arb

from lightproof import geometry, scene
from lightproof.certify import contact, contour, planes, provenance
from lightproof.certify.balls import CannotCertify, Point, dot, exact, point, unit
from lightproof.certify.contour import Contour
from lightproof.certify.emitters import Formula
from lightproof.certify.field import Field, Shape
from lightproof.certify.overlaps import Overlaps
from lightproof.certify.planes import Frame, Plane, Region
from lightproof.certify.polygon import Loop, clip, convex_parts, loop, visible_pieces
from lightproof.certify.provenance import Provenance
from lightproof.certify.sightlines import Convex
from lightproof.scene import AreaLight


def covers(light: scene.Light, blockers: list[Shape]) -> bool:
    """Whether this module knows the light behind these blockers."""
    return isinstance(light, AreaLight) and isinstance(light.shape, geometry.Polygon)


def provenance_of(light: AreaLight, blockers: list[Shape]) -> Provenance:
    """Where the formula comes from."""
    return provenance.SHADOW if blockers else provenance.POLYGON


def field(light: AreaLight, blockers: list[Shape], receiver: Plane) -> Field:
    """Lambert's formula for what the receiver sees of a polygon light above its horizon and past the blockers. Raises
    CannotCertify."""
    face, radiance, normal = _face(light.shape), exact(light.radiance), unit(receiver.normal)
    between = tuple(part for blocker in blockers for part in above(_polygon(blocker), receiver, face))
    parts = above(light.shape, receiver)

    def near(x: Point) -> Formula:
        lamp, shades = (contact.limit(tiles, x, receiver.normal) for tiles in (parts, between))
        pieces = _seen(_clipped(lamp, receiver), shades, x) if _faces(face, parts, x, receiver) else []
        contours = [Contour.at(piece, x) for piece in pieces]
        return lambda y: radiance * contour.total(contours, y, normal)

    @cache
    def overlaps(frame: Frame) -> list[Overlaps]:
        return [Overlaps(frame, normal, part, between) for part in parts]

    def flux(frame: Frame, region: Region) -> arb:
        fluxes = (one.flux(facing) for facing in planes.in_front(frame, region, face) for one in overlaps(frame))
        return radiance * sum(fluxes, arb(0))

    return Field(near, None, flux)


def above(polygon: geometry.Polygon, *floors: Plane) -> tuple[Convex, ...]:
    """Convex polygons that tile the part of a polygon in front of some planes."""
    parts = _tiles(polygon)
    for floor in floors:
        parts = _clipped(parts, floor)
    return tuple(parts)


@cache
def _tiles(polygon: geometry.Polygon) -> tuple[Convex, ...]:
    return tuple(convex_parts([point(corner) for corner in polygon.vertices]))


@cache
def _face(polygon: geometry.Polygon) -> Plane:
    return planes.of([point(corner) for corner in polygon.vertices])


def _clipped(parts: Iterable[Convex], floor: Plane) -> list[Convex]:
    return [kept for part in parts if (kept := clip(part, floor.normal, floor.offset))]


def _faces(face: Plane, parts: Iterable[Convex], x: Point, receiver: Plane) -> bool:
    """Whether a receiver is in front of a light, or on it or in its plane and comes from the front."""
    height = face.height(x)
    level = height == 0 or any(contact.holds(part, x) for part in parts)
    return bool(dot(face.normal, receiver.normal) > 0 if level else height > 0)


def _polygon(shape: Shape) -> geometry.Polygon:
    if not isinstance(shape, geometry.Polygon):
        raise CannotCertify(f"a {type(shape).__name__.lower()} stands before a polygon light; only polygon blockers are covered")
    return shape


def _seen(light: Iterable[Convex], blockers: Iterable[Convex], x: Point) -> list[Loop]:
    """Convex loops that tile what a receiver sees of a light past blockers."""
    shades = [loop(blocker, x) for blocker in blockers]
    return [piece for part in light for piece in visible_pieces(loop(part, x), shades, x)]
