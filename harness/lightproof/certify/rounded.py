"""Convex regions of directions bounded by arcs of circles, great and small: their solid angle and irradiance."""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb

from lightproof.certify.balls import Number, Vector, cross, dot, minus


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
        return ((1 - self.cosine * self.cosine) * self.turn * dot(self.axis, normal) + self.cosine * chord) / 2

    def heading(self, place: Vector) -> Vector:
        """The direction in which the arc runs through a place, of any length."""
        return cross(self.axis, place)


Contour = tuple[Arc, ...]  # round a convex region, which it keeps on its left; () where there is nothing


def projected(contour: Contour, normal: Vector) -> arb:
    """Irradiance per radiance [sr] from a region above the horizon of a receiver with unit `normal`."""
    return sum((arc.projected(normal) for arc in contour), arb(0))


def solid_angle(contour: Contour) -> arb:
    """Solid angle [sr] of a region: a whole turn, less the turns along its arcs and in its corners (Gauss and Bonnet)."""
    if not contour:
        return arb(0)
    arcs = sum((arc.cosine * arc.turn for arc in contour), arb(0))
    return 2 * arb.pi() - arcs - sum((_corner(contour[i - 1], arc) for i, arc in enumerate(contour)), arb(0))


def _corner(before: Arc, after: Arc) -> arb:
    """The turn to the left, of 0 to pi, from one arc to the next."""
    here, there = before.heading(after.start), after.heading(after.start)
    return arb.pi() / 2 - arb.atan2(dot(here, there), dot(cross(here, there), after.start))
