"""A cylinder light that is whole above the horizon: Lambert's contour integral around the half of its wall that is seen.

The outline is two lines on the wall, where planes through the receiver touch it, and the halves of both rims between them
that are nearer; in coordinates from the receiver to the axis it is the same formula wherever the receiver is.
"""

from __future__ import annotations

from flint import arb

from lightproof import geometry
from lightproof.certify.balls import Ball, Number, Vector, arctan, cross, dot, exact, minus, plus, point, root, times, unit
from lightproof.certify.emitters import Formula
from lightproof.certify.planes import Plane


def tube_light(shape: geometry.Cylinder, radiance: float, receiver: Plane) -> Formula:
    """Irradiance [W/m2] from the outside of a cylinder's wall, for receivers outside the infinite cylinder."""
    base, axis, normal = tuple(map(arb, point(shape.base))), unit(point(shape.axis)), unit(receiver.normal)
    power, radius, height = arb(exact(radiance) / 2), arb(exact(shape.radius)), arb(exact(shape.height))

    def irradiance(x: Vector) -> Ball:
        low = dot(axis, minus(base, x))
        offset = minus(minus(base, x), times(axis, low))
        ends = low, low + height
        rims = [_rim(offset, axis, radius, end, normal) for end in ends]
        return power * (rims[1] - rims[0] + _lines(offset, axis, radius, ends, normal))

    return irradiance


def _lines(offset: Vector, axis: Vector, radius: Number, ends: tuple[Ball, Ball], normal: Vector) -> Ball:
    """The two straight parts: angle times cosine, up the one and down the other."""
    reach = root(dot(offset, offset) - radius * radius)
    angle = arctan(ends[1] / reach) - arctan(ends[0] / reach)
    between = times(cross(axis, offset), 2 * radius / dot(offset, offset))
    return angle * dot(normal, cross(between, axis))


def _rim(offset: Vector, axis: Vector, radius: Number, height: Ball, normal: Vector) -> Ball:
    """The nearer half of a rim, counter-clockwise about the axis. On it |r|^2 = p - q cos f from f = -end to end, and with
    d^2 = p^2 - q^2 and k = q / (p + d) it is (d - k ...) that do not cancel where the rim is small."""
    square = dot(offset, offset)
    distance = root(square)
    p, q = square + height * height + radius * radius, 2 * radius * distance
    near, far = distance - radius, distance + radius
    d = root((height * height + near * near) * (height * height + far * far))
    k, cosine = q / (p + d), radius / distance
    sine = root(1 - cosine * cosine)
    end, bend = arctan(sine / cosine), arctan(k * sine / (1 - k * cosine))
    whole, cosines = 2 / d * (end + 2 * bend), 2 / d * (k * end + (1 + k * k) / k * bend)
    first = times(offset, -1 / distance)
    centre = plus(offset, times(axis, height))
    return radius * (radius * dot(normal, axis) * whole + dot(normal, cross(centre, cross(axis, first))) * cosines)
