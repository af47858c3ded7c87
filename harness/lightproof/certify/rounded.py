"""Convex regions of directions bounded by arcs of circles, great and small: their solid angle and irradiance."""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb

from lightproof.certify.balls import Number, Vector, angle, cross, dot, minus, root


@dataclass(frozen=True)
class Arc:
    """A part of a circle round a unit `axis`, `cosine` being that of the angle between them, run through counter-clockwise by
    `turn` radians from `start` to `end`, which are unit vectors."""

    axis: Vector
    cosine: Number
    start: Vector
    end: Vector
    turn: arb

    def projected(self, normal: Vector) -> arb:
        """The part of Lambert's contour integral along the arc, half of (w x dw) . normal [sr]."""
        chord = dot(cross(self.axis, minus(self.end, self.start)), normal)
        return ((1 - self.cosine**2) * self.turn * dot(self.axis, normal) + self.cosine * chord) / 2

    def beyond_chord(self) -> arb:
        """Solid angle [sr] between the arc and the great circle through its ends: a sector of the cap less a triangle."""
        if self.cosine == 0:
            return arb(0)
        return (1 - self.cosine) * self.turn - triangle(self.axis, self.start, self.end)


Contour = tuple[Arc, ...]  # round a convex region, which it keeps on its left; () where there is nothing


def projected(contour: Contour, normal: Vector) -> arb:
    """Irradiance per radiance [sr] from a region above the horizon of a receiver with unit `normal`."""
    return sum((arc.projected(normal) for arc in contour), arb(0))


def solid_angle(contour: Contour) -> arb:
    """Solid angle [sr] of a region."""
    if not contour:
        return arb(0)
    fan = sum((triangle(contour[0].start, arc.start, arc.end) for arc in contour[1:-1]), arb(0))
    return fan + sum((arc.beyond_chord() for arc in contour), arb(0))


def triangle(a: Vector, b: Vector, c: Vector) -> arb:
    """Signed solid angle [sr] of the triangle in which three directions, of any length, are seen (Van Oosterom and Strackee
    1983): positive where a, b, c run counter-clockwise."""
    la, lb, lc = (root(dot(side, side)) for side in (a, b, c))
    ab, bc, ca = la * lb + dot(a, b), lb * lc + dot(b, c), lc * la + dot(c, a)
    volume = dot(a, cross(minus(b, a), minus(c, a)))
    return 2 * angle(volume, ab * lc + lb * dot(c, a) + la * dot(b, c), root(2 * ab * bc * ca))
