"""What may stand between a light and receivers."""

from __future__ import annotations

from collections.abc import Sequence

from lightproof import geometry, scene
from lightproof.certify import parting
from lightproof.certify.balls import Point, dot, point
from lightproof.certify.field import Shape
from lightproof.certify.planes import Plane


def may_hide(blocker: Shape, light: scene.Light, receivers: Sequence[Point]) -> bool:
    """False where a flat blocker's plane has the light and all receivers, which may be the corners of where they are, on one
    side of it or on itself."""
    if not isinstance(blocker, geometry.Polygon | geometry.Disk):
        return True
    face = parting.face(parting.solid(blocker))
    return not any(_beside(blocker, light, receivers, side) for side in (face, face.turned))


def _beside(blocker: Shape, light: scene.Light, receivers: Sequence[Point], side: Plane) -> bool:
    corners = [point(corner) for corner in blocker.vertices] if isinstance(blocker, geometry.Polygon) else []
    plane = Plane(side.normal, max((dot(side.normal, corner) for corner in corners), default=side.offset))
    return all(plane.height(x) >= 0 for x in receivers) and _above(light, plane)


def _above(light: scene.Light, plane: Plane) -> bool:
    """Whether no part of a light is known to be behind a plane; a point light on it has no side."""
    match light:
        case scene.AreaLight():
            return parting.above(parting.solid(light.shape), plane)
        case scene.PointLight():
            return plane.height(point(light.position)) > 0
        case scene.DirectionalLight():
            return dot(plane.normal, point(light.direction)) <= 0
    return False
