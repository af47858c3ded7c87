"""What a receiver sees, put together from circles on its sphere of directions, and the irradiance from it.

Every circle is cut at its crossings with all others. Between two crossings the visible part lies on the left, on the right,
on both sides or on neither of them, which is decided once, in the middle; its boundary is where the two sides differ, and
Lambert's contour integral runs along that. Crossings are balls: what happens inside one is not decided but bounded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations

from flint import arb

from lightproof.certify.balls import Vector
from lightproof.certify.circles import Circle
from lightproof.certify.crossings import crossings

Side = Callable[[Circle], bool]  # whether the direction in question is on a circle's left
Span = tuple[arb, arb]  # angles
Cut = tuple[arb, arb, bool]  # angles, and whether just one crossing is between them


@dataclass(frozen=True)
class Outline:
    """A part of the sphere of directions: the circles on which its boundary lies, and which directions it contains."""

    circles: tuple[Circle, ...]
    contains: Callable[[Side], bool]


NOTHING = Outline((), lambda side: False)
EVERYTHING = Outline((), lambda side: True)


def visible(light: Outline, horizon: Outline, blockers: Sequence[Outline]) -> Outline:
    """What is seen of a light above the horizon and past blockers."""
    circles = tuple(circle for outline in (light, horizon, *blockers) for circle in outline.circles)

    def contains(side: Side) -> bool:
        seen = light.contains(side) and horizon.contains(side)
        return seen and not any(blocker.contains(side) for blocker in blockers)

    return Outline(circles, contains)


def irradiance(seen: Outline, normal: Vector) -> arb:
    """Irradiance per radiance [sr] of a receiver with unit `normal`, from a part above its horizon. Raises Undecided."""
    first = {circle.key: circle for circle in reversed(seen.circles)}
    same = {id(circle): first[circle.key] for circle in seen.circles}
    marks: dict[int, list[arb]] = {id(circle): [] for circle in first.values()}
    for a, b in combinations(first.values(), 2):
        for direction in crossings(a, b):
            marks[id(a)].append(a.angle(direction))
            marks[id(b)].append(b.angle(direction))
    sign_at = partial(_sign, seen, same)
    return sum((_boundary(sign_at, circle, marks[id(circle)], normal) for circle in first.values()), arb(0)) / 2


def _boundary(sign_at: Callable[[Circle, arb], int], circle: Circle, marks: Iterable[arb], normal: Vector) -> arb:
    """The contour integral along the parts of a circle on which the boundary lies."""
    cuts = merged(marks)
    if not cuts:
        return sign_at(circle, arb(0)) * circle.contour(-arb.pi(), arb.pi(), normal)
    ends = [*cuts[1:], (cuts[0][0] + 2 * arb.pi(), arb(0), True)]
    spans = [(cut[1], after[0]) for cut, after in zip(cuts, ends, strict=True)]
    signs = [sign_at(circle, (start.mid() + end.mid()) / 2) if start < end else None for start, end in spans]
    total = sum((sign * circle.contour(*span, normal) for sign, span in zip(signs, spans, strict=True) if sign), arb(0))
    for cut, span, before, after in zip(cuts, spans, signs[-1:] + signs[:-1], signs, strict=True):
        total += _bound(circle, cut, before, after) + _bound(circle, (*span, False), None, None) * (after is None)
    return total


def _bound(circle: Circle, cut: Cut, before: int | None, after: int | None) -> arb:
    """Holds the integral along an undecided part, between parts of known signs."""
    if cut[2] and before == after == 0:
        return arb(0)
    return arb(0, (abs(cut[1] - cut[0]) * circle.steepest).abs_upper())


def _sign(seen: Outline, same: Mapping[int, Circle], circle: Circle, angle: arb) -> int:
    """1 where the visible part is on the left of a circle only, -1 where it is on the right only, else 0; `same` is the circle
    that stands for each of those that coincide, by identity."""
    direction = circle.at(angle)
    known: dict[int, bool] = {}

    def left(other: Circle) -> bool:
        if id(other) not in known:
            known[id(other)] = other.left(direction)
        return known[id(other)]

    def beside(on_left: bool) -> bool:
        return seen.contains(lambda other: on_left == circle.along(other) if same.get(id(other)) is circle else left(other))

    return beside(True) - beside(False)


def merged(marks: Iterable[arb]) -> list[Cut]:
    """Disjoint intervals, in order, that hold all marks."""
    cuts: list[Cut] = []
    for low, high in sorted((mark.lower(), mark.upper()) for mark in marks):
        if cuts and not low > cuts[-1][1]:
            cuts[-1] = (cuts[-1][0], max(cuts[-1][1], high), False)
        else:
            cuts.append((low, high, True))
    return cuts
