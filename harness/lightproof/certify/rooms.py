"""Rooms: convex polygons that close round a space without a gap, all facing in. Everything here is exact."""

from __future__ import annotations

from collections.abc import Sequence

from lightproof import geometry
from lightproof.certify import planes
from lightproof.certify.balls import CannotCertify, Point, Rational, cross, dot, exact, minus, plus, point, times
from lightproof.certify.polygon import area_vector
from lightproof.scene import Surface

Corners = tuple[Point, ...]


def is_closed(surfaces: Sequence[Surface]) -> bool:
    """Whether there are polygons only, each of their edges is run through once either way, and their fronts face in."""
    shapes = [surface.shape for surface in surfaces]
    if not shapes or not all(isinstance(shape, geometry.Polygon) for shape in shapes):
        return False
    edges = [edge for shape in shapes for edge in zip(shape.vertices, (*shape.vertices[1:], shape.vertices[0]), strict=True)]
    return sorted(edges) == sorted((end, start) for start, end in edges) and sum(map(_volume, shapes)) < 0


def _volume(shape: geometry.Polygon) -> Rational:
    """Six times the volume of the cone from the origin to a polygon, negative where it faces the origin."""
    corners = [point(vertex) for vertex in shape.vertices]
    return dot(corners[0], area_vector(corners))


def walls(surfaces: Sequence[Surface]) -> list[Corners]:
    """The corners of the walls of a room. Raises CannotCertify where one is behind another: the room is not convex then, or
    its walls face out, or the numbers that round its corners have bent a wall."""
    every = [tuple(point(vertex) for vertex in surface.shape.vertices) for surface in surfaces]
    for corners, surface in zip(every, surfaces, strict=True):
        plane = planes.of(corners)
        if any(plane.height(corner) < 0 for wall in every for corner in wall):
            raise CannotCertify(f"a corner of the room is behind its wall '{surface.id}'; exactly convex rooms are covered")
    return every


def check_within(room: Sequence[Corners], corners: Sequence[Point], normal: Point) -> None:
    """A film is in a room, and where it lies on a wall it faces as the wall does. Raises CannotCertify."""
    for plane in map(planes.of, room):
        heights = [plane.height(corner) for corner in corners]
        if min(heights) < 0:
            raise CannotCertify("the film reaches out of the room")
        if max(heights) == 0 and not (dot(plane.normal, normal) > 0 and not any(cross(plane.normal, normal))):
            raise CannotCertify("the film touches a wall and does not face as the wall does")


def is_middle_of_cube(room: Sequence[Corners], x: Point) -> bool:
    """Whether the room is a cube and x its centre: every wall is a square, and x half its side above its middle."""
    return len(room) == 6 and all(_is_square_beneath(wall, x) for wall in room)


def _is_square_beneath(wall: Corners, x: Point) -> bool:
    if len(wall) != 4 or any(minus(plus(wall[0], wall[2]), plus(wall[1], wall[3]))):
        return False
    up = minus(times(x, exact(2)), plus(wall[0], wall[2]))
    arms = (minus(wall[1], wall[0]), minus(wall[3], wall[0]), up)
    squares = {dot(arm, arm) for arm in arms}
    return len(squares) == 1 and not any(dot(arms[i - 1], arms[i]) for i in range(3))


def area(room: Sequence[Corners]) -> Rational:
    """Area of a cube's walls."""
    side = minus(room[0][1], room[0][0])
    return 6 * dot(side, side)
