"""The share of a pixel in which a camera sees something round: all rays of a cone, whose image is an ellipse.

An affine map takes the ellipse to the unit circle and the pixel to a parallelogram; what they have in common is a sum over
the parallelogram's edges of triangles, where an edge is inside the circle, and of sectors, where it is outside.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import arb, arb_mat

from lightproof.certify.balls import Ball, CannotCertify, Number, Undecided, Vector, dot, minus, root, times
from lightproof.certify.camera import Camera

Flat = tuple[Ball, Ball]


@dataclass(frozen=True)
class Cone:
    """The directions d with d . `form` d > 0 that are on the side of `inner`, one of them."""

    form: arb_mat
    inner: Vector


def around_sphere(eye: Vector, centre: Vector, radius: Number) -> Cone:
    """The rays from `eye`, outside a sphere, that meet it: (d . c)^2 > d^2 (c^2 - R^2), c the way to the centre."""
    c = minus(centre, eye)
    return Cone(_outer(c, c) - arb_mat(3, 3, 1) * arb(dot(c, c) - radius * radius), c)


def through_disk(eye: Vector, centre: Vector, axis: Vector, radius: Number) -> Cone:
    """The rays from `eye`, off the disk's plane, that meet it; with o = eye - centre and h = -o . axis, the one along d meets
    the plane h d + (d . axis) o, over d . axis, off the disk's centre."""
    o = minus(eye, centre)
    h = arb(-dot(o, axis))
    mixed = _outer(axis, o)
    form = _outer(axis, axis) * arb(radius * radius - dot(o, o)) - (mixed + mixed.transpose()) * h - arb_mat(3, 3, 1) * (h * h)
    return Cone(form, times(o, -1))


def share(camera: Camera, element: int, cone: Cone) -> arb:
    """The part of a pixel's square from which the rays of a pinhole camera lie in a cone. Raises CannotCertify where the
    cone's image is no ellipse."""
    _, middle = camera.within(element, arb(0), arb(0))
    across, along = (minus(camera.within(element, *step)[1], middle) for step in ((arb(1), arb(0)), (arb(0), arb(1))))
    basis = arb_mat([[arb(vector[i]) for vector in (across, along, middle)] for i in range(3)])
    form = basis.transpose() * cone.form * basis
    a, b, c = -form[0, 0], -form[0, 1], -form[1, 1]
    square = a * c - b * b
    if not (a > 0 and square > 0):
        raise CannotCertify("what the camera sees of a round edge is no ellipse; turn the camera towards it, or away")
    if not _decided(dot(cone.inner, camera.forward)):
        return arb(0)
    s, t = (c * form[0, 2] - b * form[1, 2]) / square, (a * form[1, 2] - b * form[0, 2]) / square
    size = form[2, 2] + s * form[0, 2] + t * form[1, 2]
    if not _decided(size):
        return arb(0)
    corners = [_straightened(x - s, y - t, (a, b, square / a), size) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return in_circle(corners) * size / (4 * root(square))


def _straightened(x: Ball, y: Ball, ellipse: tuple[Ball, Ball, Ball], size: Ball) -> Flat:
    """The affine map that takes a x^2 + 2 b x y + c y^2 = `size` to the unit circle; `ellipse` is a, b and c - b^2/a."""
    a, b, rest = ellipse
    return root(a / size) * (x + b * y / a), root(rest / size) * y


def in_circle(corners: Sequence[Flat]) -> arb:
    """Area that a polygon, counter-clockwise, has in common with the unit circle."""
    return sum((_edge(corners[i - 1], corners[i]) for i in range(len(corners))), arb(0)) / 2


def _edge(a: Flat, b: Flat) -> arb:
    """Twice the signed area between the centre and an edge, in the circle."""
    d = b[0] - a[0], b[1] - a[1]
    squared, towards = d[0] * d[0] + d[1] * d[1], -(a[0] * d[0] + a[1] * d[1])
    inside = towards * towards - squared * (a[0] * a[0] + a[1] * a[1] - 1)
    if not inside > 0:
        return _sector(a, b) + _grazed(inside, root(inside.abs_upper() / squared) ** 3)
    enter, leave = (towards - root(inside)) / squared, (towards + root(inside)) / squared
    start, end = enter.max(arb(0)), leave.min(arb(1))
    if not end > start:
        return _sector(a, b) + _grazed(end - start, (end - start).abs_upper() * root(squared))
    p, q = ((a[0] + d[0] * u, a[1] + d[1] * u) for u in (start, end))
    outside = (arb(0) if enter < 0 else _sector(a, p)) + (arb(0) if leave > 1 else _sector(q, b))
    return outside + p[0] * q[1] - p[1] * q[0]


def _grazed(inside: arb, bound: arb) -> arb:
    """What an edge that is all but outside may lack of a sector, and nothing where it surely is outside: twice the area between
    arc and chord, at most 4 l^3 where half the chord is l, at most 4 l where the edge ends l inside."""
    return arb(0) if inside <= 0 else arb(0, 4 * bound)


def _sector(a: Flat, b: Flat) -> arb:
    """The angle from a to b, less than half a turn."""
    return arb.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])


def _decided(x: Ball) -> bool:
    """Whether a ball is positive. Raises Undecided."""
    if not (x > 0 or x <= 0):
        raise Undecided("what is round is seen too nearly edge-on to tell on which side it is")
    return x > 0


def _outer(a: Vector, b: Vector) -> arb_mat:
    return arb_mat([[arb(x * y) for y in b] for x in a])
