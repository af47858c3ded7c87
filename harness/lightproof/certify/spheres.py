"""Where points are with regard to a sphere: on it but for rounding, or strictly on one side. All exact."""

from __future__ import annotations

from collections.abc import Iterable

from lightproof import geometry
from lightproof.certify.balls import CannotCertify, Point, Rational, cross, dot, exact, minus, point

ROUNDING = exact(1e-15)  # of the radius: how far the binary64 position of a point of the sphere may lie off it

Round = geometry.Sphere | geometry.Cap


def check_within(sphere: Round, positions: Iterable[Point]) -> None:
    """All are strictly inside. Raises CannotCertify."""
    for position in positions:
        if not _squared(sphere, position) < exact(sphere.radius) ** 2:
            raise CannotCertify(f"{_shown(position)} does not lie inside the sphere")


def check_outside(sphere: Round, positions: Iterable[Point]) -> None:
    """All are strictly outside. Raises CannotCertify."""
    for position in positions:
        if not _squared(sphere, position) > exact(sphere.radius) ** 2:
            raise CannotCertify(f"{_shown(position)} does not lie outside the sphere")


def is_on(sphere: Round, position: geometry.Vec3) -> bool:
    """Whether a point lies on the sphere, but for rounding."""
    square = exact(sphere.radius) ** 2
    return abs(_squared(sphere, point(position)) - square) <= 2 * ROUNDING * square


def check_faces(sphere: Round, position: geometry.Vec3, normal: geometry.Vec3, inward: bool) -> None:
    """A receiver looks straight at the centre, or straight away from it, but for rounding. Raises CannotCertify."""
    ray, n = minus(point(sphere.center), point(position)), point(normal)
    aside = cross(ray, n)
    if (dot(ray, n) > 0) != inward or dot(aside, aside) > ROUNDING**2 * dot(ray, ray) * dot(n, n):
        raise CannotCertify(f"{list(position)} is on the wall and does not face {'the' if inward else 'away from its'} centre")


def _squared(sphere: Round, position: Point) -> Rational:
    """Squared distance from the centre."""
    ray = minus(position, point(sphere.center))
    return dot(ray, ray)


def _shown(position: Point) -> list[float]:
    return [float(component) for component in position]
