"""A rectangle that shines on a film which stands on its plane at right angles, as a lit floor shines on a wall. At the foot
Lambert's formula is not smooth; the mean over a cell is the form factor of two rectangles, smooth or not."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

from flint import arb, fmpq

from lightproof import geometry
from lightproof.certify import direct, planes
from lightproof.certify.balls import Ball, Element, Point, Rational, cross, dot, exact, minus, plus, point, root
from lightproof.certify.planes import Frame, Plane
from lightproof.certify.provenance import Provenance
from lightproof.scene import AreaLight, PlaneFilm, Scene

FORMULA = Provenance(
    "mean of E = (L/2 A) Σ ± [d s atan(d/s) − ¼ (s² − d²) ln(s² + d²)] over the corners of cell and light: s is how far both"
    " together are off the line where their planes meet, s² = x² + ξ², and d how far apart along it",
    "The form factor between perpendicular rectangles in Howell's catalogue.",
    ("howell",),
)


def covers(scene: Scene) -> bool:
    """Whether one rectangle shines, nothing stands between, and the film stands on its plane, aligned and at right angles."""
    if scene.reflects or len(scene.lights) != 1 or not isinstance(scene.film, PlaneFilm):
        return False
    light, film = scene.lights[0], Frame.of(scene.film)
    if not isinstance(light, AreaLight) or not isinstance(light.shape, geometry.Polygon):
        return False
    hidden = all(surface.radiance == 0 and direct.lies_on(surface.shape, film.plane) for surface in scene.surfaces)
    return hidden and _stands_on(film, tuple(map(point, light.shape.vertices)))


def _stands_on(film: Frame, light: Sequence[Point]) -> bool:
    """Whether the two are rectangles with sides along the line where their planes meet, at right angles; each reaches down to
    the other's plane and is in front of it."""
    face, receiver = planes.of(light), film.plane
    along = cross(face.normal, receiver.normal)
    a, b = minus(light[1], light[0]), minus(light[-1], light[0])
    rectangle = len(light) == 4 and not any(minus(plus(light[0], light[2]), plus(light[1], light[3])))
    square = rectangle and not (dot(a, b) or dot(film.u, film.v) or dot(face.normal, receiver.normal))
    aligned = square and all(not any(cross(side, along)) or not dot(side, along) for side in (a, film.u))
    heights = [[receiver.height(corner) for corner in light], [face.height(corner) for corner in _outline(film)]]
    return aligned and all(min(each) == 0 for each in heights)


def _outline(film: Frame) -> list[Point]:
    return [film.at(exact(p), exact(q)) for p, q in ((0, 0), (1, 0), (1, 1), (0, 1))]


def kind(scene: Scene) -> str:
    """Closed forms."""
    return "enclosure"


def provenance_of(scene: Scene) -> Provenance:
    """Where the formula comes from."""
    return FORMULA


def solve(scene: Scene) -> Element:
    """Mean irradiance of each cell."""
    light, film = tuple(map(point, scene.lights[0].shape.vertices)), Frame.of(scene.film)
    face, receiver = planes.of(light), film.plane
    along = Plane(cross(face.normal, receiver.normal), fmpq(0))

    def element(index: int) -> arb:
        cell = [film.at(*position) for position in film.cell(index)]
        across = _ends(receiver, light), _ends(face, cell)
        beside = _ends(along, light), _ends(along, cell)
        area = (across[1][1] - across[1][0]) * (beside[1][1] - beside[1][0]) / (_length(face) * _length(along))
        scales = _length(receiver), _length(face), _length(along)
        return exact(scene.lights[0].radiance) / (2 * area) * _corners(across, beside, scales)

    return element


def _ends(plane: Plane, corners: Sequence[Point]) -> tuple[Rational, Rational]:
    """The least and the greatest height above a plane, times the length of its normal."""
    heights = [plane.height(corner) for corner in corners]
    return min(heights), max(heights)


def _length(plane: Plane) -> arb:
    return root(dot(plane.normal, plane.normal))


def _corners(across: Sequence[tuple[Rational, Rational]], beside: Sequence[tuple[Rational, Rational]],
             scales: tuple[arb, arb, arb]) -> arb:
    """The sum over the four corners of the light and the four of the cell."""
    total = arb(0)
    for i, j, k, n in product(range(2), repeat=4):
        x, up, d = across[0][i] / scales[0], across[1][j] / scales[1], (beside[0][k] - beside[1][n]) / scales[2]
        total += (-1) ** (i + j + k + n) * _term(x * x + up * up, d)
    return total


def _term(square: Ball, d: Ball) -> Ball:
    """d s atan(d/s) - (s^2 - d^2) ln(s^2 + d^2) / 4, s the root of `square`; 0 where both are."""
    both = square + d * d
    if both == 0:
        return arb(0)
    s = root(square)
    turn = d * s * (d / s).atan() if s != 0 else arb(0)
    return turn - (square - d * d) * both.log() / 4
