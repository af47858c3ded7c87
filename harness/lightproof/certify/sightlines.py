"""Where, as a receiver moves over a plane, what it sees of several convex polygons changes its shape."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

from lightproof.certify import planes
from lightproof.certify.balls import Point, Vector, cross, dot, minus
from lightproof.certify.contour import meet
from lightproof.certify.planes import Plane
from lightproof.certify.polygon import Edge

Convex = tuple[Point, ...]
Wedge = tuple[Plane, ...]  # the points in front of all


@dataclass(frozen=True)
class Sightline:
    """A plane, and the wedges outside which nothing changes as a receiver crosses it."""

    plane: Plane
    wedges: tuple[Wedge, ...]

    def parts(self, a: Vector, b: Vector) -> bool:
        """Whether something may change where a receiver crosses the plane between two of its points."""
        return any(all(_reaches(guard, a, b) for guard in wedge) for wedge in self.wedges)


def _reaches(guard: Plane, a: Vector, b: Vector) -> bool:
    ends = guard.height(a), guard.height(b)
    return max(ends) > 0 or ends == (0, 0)


def before(light: Convex, blocker: Convex) -> Iterator[Sightline]:
    """What changes the part of a light that is behind a blocker: the blocker is seen edge-on, a corner of the light comes out
    behind an edge of the blocker, or an edge of the light behind a corner of the blocker."""
    yield Sightline(planes.of(blocker), ((),))
    yield from (line for corner, edge in product(light, edges(blocker)) for line in _corner_on_edge(corner, edge, "behind"))
    yield from (line for corner, edge in product(blocker, edges(light)) for line in _corner_on_edge(corner, edge, "before"))


def beside(a: Convex, b: Convex) -> Iterator[Sightline]:
    """What changes the part that two polygons seem to share, whichever is nearer."""
    for corners, other in ((a, b), (b, a)):
        yield from (line for corner, edge in product(corners, edges(other))
                    for line in _corner_on_edge(corner, edge, "behind", "before"))


def through_meetings(polygons: Sequence[Convex]) -> Iterator[Sightline]:
    """What changes the part that three polygons seem to share, where edges of two of them meet in a point: an edge of the third
    passes it."""
    for i, third in enumerate(polygons):
        a, b = (polygon for j, polygon in enumerate(polygons) if j != i)
        for first, second in product(edges(a), edges(b)):
            point = meet(first, second)
            if point and _within(point, first) and _within(point, second):
                yield from (line for edge in edges(third) for line in _corner_on_edge(point, edge, "behind", "before"))


def edges(polygon: Convex) -> tuple[Edge, ...]:
    """The sides of a polygon."""
    return tuple(zip(polygon, (*polygon[1:], polygon[0]), strict=True))


def _within(point: Point, edge: Edge) -> bool:
    return dot(minus(point, edge[0]), minus(point, edge[1])) <= 0


def _corner_on_edge(corner: Point, edge: Edge, *places: str) -> Iterator[Sightline]:
    """The plane through both, where it is one: receivers from which the corner is behind the edge or before it."""
    plane = planes.through(corner, *edge)
    if any(plane.normal):
        wedges = {"behind": _past, "before": _opposite}
        yield Sightline(plane, tuple(wedges[place](plane, corner, edge) for place in places))


def _past(plane: Plane, corner: Point, edge: Edge) -> Wedge:
    """Between the rays from the corner through the edge's ends, beyond the edge."""
    start, end = edge
    return (_side(plane, corner, minus(start, corner)), _side(plane, corner, minus(corner, end)),
            _side(plane, start, minus(start, end)))


def _opposite(plane: Plane, corner: Point, edge: Edge) -> Wedge:
    """Between the rays from the corner away from the edge's ends."""
    return _side(plane, corner, minus(corner, edge[0])), _side(plane, corner, minus(edge[1], corner))


def _side(plane: Plane, point: Point, along: Vector) -> Plane:
    """The plane through a line of another plane that is square to that plane; its front is on the line's left."""
    normal = cross(plane.normal, along)
    return Plane(normal, dot(normal, point))
