"""How a receiver, which is the origin here, sees the wall of a cylinder that is open at both ends.

From outside the wall is seen between the two planes that touch it. There a ray enters the infinite cylinder and leaves it, and
each time it meets the wall, or passes an end. Which, the outlines of the two openings tell: the nearer half of a rim bounds
where rays enter, the farther half where they leave. From inside the wall is all around but for the openings.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from lightproof import geometry
from lightproof.certify import balls
from lightproof.certify.arrangement import NOTHING, Outline, Side
from lightproof.certify.balls import CannotCertify, Number, Point, Rational, cross, dot, exact, minus, plus, point, times
from lightproof.certify.circles import Circle, Great, Rim, positive


@dataclass(frozen=True, eq=False)
class End:
    """One end of a wall, at which a ray passes the wall or not. `outwards` (1 or -1) times the wall's axis leads out of it;
    `height` is axis . centre. `chord` is the plane through the receiver that cuts the rim where rays touch the wall."""

    rim: Rim | None
    chord: Great
    outwards: int
    height: Number

    @property
    def circles(self) -> tuple[Circle, ...]:
        """The circles on which the end's outline lies: a rim seen edge-on is part of a great circle."""
        return (self.rim,) if self.rim else (self.chord,)

    @property
    def before(self) -> bool:
        """Whether the receiver is on the inner side of the end's plane."""
        return bool(self.outwards * self.height > 0)

    def through(self, side: Side) -> bool:
        """Whether a direction leads through the opening."""
        return self.rim is not None and side(self.rim)

    def entering(self, side: Side) -> bool:
        """Whether a ray that meets the infinite cylinder from outside does so before the end."""
        inner = side(self.chord) == (self.outwards < 0)
        return (inner or self.through(side)) if self.before else (inner and not self.through(side))

    def leaving(self, side: Side) -> bool:
        """Whether a ray that meets the infinite cylinder from inside, having entered it, does so before the end."""
        inner = side(self.chord) == (self.outwards < 0)
        return (inner and not self.through(side)) if self.before else (inner or self.through(side))


@dataclass(frozen=True)
class Wall:
    """A wall: its axis, the exact offset of the axis's line from the receiver, squared radius and two ends."""

    axis: Point
    offset: Point
    square: Rational
    ends: tuple[End, End]

    @classmethod
    def of(cls, shape: geometry.Cylinder, receiver: Point) -> Wall:
        """How a receiver sees a cylinder. Raises CannotCertify where it stands on the cylinder, or in line with its wall."""
        base, axis, square = minus(point(shape.base), receiver), point(shape.axis), exact(shape.radius) ** 2
        low = dot(axis, base)
        offset = minus(base, times(axis, low / dot(axis, axis)))
        if dot(offset, offset) == square:
            raise CannotCertify("a receiver is in line with the wall of a cylinder")
        heights = low, low + exact(shape.height) * balls.exact_root(dot(axis, axis))
        ends = (_end(axis, offset, square, height, sign) for height, sign in zip(heights, (-1, 1), strict=True))
        return cls(axis, offset, square, tuple(ends))

    @property
    def reach(self) -> Rational:
        """The squared length of the tangents from the receiver to the infinite cylinder; negative inside it."""
        return dot(self.offset, self.offset) - self.square

    @cached_property
    def sides(self) -> tuple[Great, Great]:
        """The planes that touch the wall, the wall on their left."""
        beside = times(cross(self.axis, self.offset), balls.root(self.square * self.reach / dot(self.axis, self.axis)))
        touches = [plus(times(self.offset, self.reach), times(beside, sign)) for sign in (-1, 1)]
        return Great(cross(self.axis, touches[0])), Great(cross(touches[1], self.axis))

    @property
    def circles(self) -> tuple[Circle, ...]:
        """The circles on which the outlines lie, for a receiver outside the infinite cylinder."""
        return (*self.sides, *self.ends[0].circles, *self.ends[1].circles)

    @property
    def outside(self) -> Outline:
        """The outer face of the wall."""
        if self.reach < 0:
            return NOTHING
        return Outline(self.circles, lambda side: all(map(side, self.sides)) and all(end.entering(side) for end in self.ends))

    @property
    def either(self) -> Outline:
        """The wall, its outer face or its inner."""
        return self._within if self.reach < 0 else Outline(self.circles, self._wall)

    def _wall(self, side: Side) -> bool:
        return all(map(side, self.sides)) and (
            all(end.entering(side) for end in self.ends) or all(end.leaving(side) for end in self.ends))

    @property
    def _within(self) -> Outline:
        """The inner face, for a receiver inside the infinite cylinder: what it does not see the openings in."""
        openings = [end for end in self.ends if end.rim]
        if len(openings) < 2:
            raise CannotCertify("a receiver is in the opening of a cylinder")
        near = [end for end in openings if not end.before]
        far = [end for end in openings if end.before]

        def contains(side: Side) -> bool:
            return all(end.through(side) for end in near) and not any(end.through(side) for end in far)

        return Outline(tuple(end.rim for end in openings), contains)


def _end(axis: Point, offset: Point, square: Rational, height: Number, outwards: int) -> End:
    reach = dot(offset, offset) - square
    chord = Great(minus(times(axis, reach), times(offset, height)))
    if height == 0:
        return End(None, Great(axis), outwards, height)
    sign = 1 if positive(height) else -1
    return End(Rim(offset, times(axis, sign), sign * height, square), chord, outwards, height)
