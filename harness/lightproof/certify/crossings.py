"""Where two circles on the sphere of directions may cross: balls of directions that hold every crossing."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from flint import arb, ctx

from lightproof.certify.balls import Undecided, Vector, cross, dot, root, times
from lightproof.certify.circles import Circle, Great, Rim

SPLIT = 12  # parts of a turn to begin with
MOST_PARTS = 200  # that may hold a root at the same time


def crossings(a: Circle, b: Circle) -> list[Vector]:
    """Directions that hold every crossing of two circles. Raises Undecided where the circles may coincide."""
    if isinstance(a, Great) and isinstance(b, Great):
        both = cross(a.normal, b.normal)
        return [both, times(both, -1)]
    if isinstance(a, Rim) and isinstance(b, Rim):
        return [a.at(angle) for angle in Wave.of(a, b).roots()]
    return _through(a, b) if isinstance(a, Rim) else _through(b, a)


def _through(rim: Rim, great: Great) -> list[Vector]:
    """Where a plane through the receiver meets a rim: level + x cos f + y sin f = 0."""
    x, y = (rim.radius * dot(great.normal, side) for side in rim.basis)
    level, square = arb(dot(great.normal, rim.centre)), x * x + y * y
    excess = square - level * level
    if excess < 0:
        return []
    reach = root(excess.nonnegative_part())
    return [rim.towards((-level * x - sign * reach * y) / square, (-level * y + sign * reach * x) / square) for sign in (1, -1)]


@dataclass(frozen=True)
class Wave:
    """level + x cos f + y sin f + u cos 2f + v sin 2f."""

    level: arb
    x: arb
    y: arb
    u: arb
    v: arb

    @classmethod
    def of(cls, path: Rim, rim: Rim) -> Wave:
        """The form of a rim's cone, along another rim."""
        r, c, (a, b) = path.radius, path.centre, path.basis
        along, beside = path.square * rim.form(a, a), path.square * rim.form(b, b)
        return cls(rim.form(c, c) + (along + beside) / 2, 2 * r * rim.form(c, a), 2 * r * rim.form(c, b),
                   (along - beside) / 2, path.square * rim.form(a, b))

    @cached_property
    def slope(self) -> Wave:
        """The derivative."""
        return Wave(arb(0), self.y, -self.x, 2 * self.v, -2 * self.u)

    def __call__(self, f: arb) -> arb:
        sine, cosine = f.sin_cos()
        return self.level + self.x * cosine + self.y * sine + self.u * (2 * cosine * cosine - 1) + 2 * self.v * sine * cosine

    def roots(self) -> list[arb]:
        """Balls of angles in a turn that hold every root, each one, or two where the slope vanishes. Raises Undecided."""
        half = arb.pi().upper() / SPLIT
        parts, found = [half * (2 * i + arb(0, 1)) for i in range(SPLIT)], []
        while parts:
            if len(parts) > MOST_PARTS:
                raise Undecided("the rims of two disks coincide as a receiver sees them")
            part = parts.pop(0)
            flat = self.slope(part).contains(0)
            rest = self._step(part)
            if not rest.overlaps(part):
                continue
            rest = rest.intersection(part)
            if 2 * rest.rad() < part.rad():
                parts.append(rest)
            elif part.rad() < arb(2) ** (8 - ctx.prec // 2):
                found += [rest, rest] if flat else [rest]
            else:
                parts += [part.mid() + part.rad() / 2 * (sign + arb(0, 1)) for sign in (-1, 1)]
        return found

    def _step(self, part: arb) -> arb:
        """A ball that holds every root in a part: by Newton's method, or the part itself where its slope may vanish; or one
        outside the part, where there is no root."""
        middle = part.mid()
        value, slope = self(middle), self.slope(part)
        if slope.contains(0):
            return part if (value + slope * (part - middle)).contains(0) else part + 4 * part.rad()
        return middle - value / slope
