"""The first engine: from a scene to proven values.

Each module of SOLVERS knows one kind of scene: `covers(scene)` says whether it is the one, `solve(scene)` gives the value of
an element as a ball, `kind(scene)` whether that ball is a proven "enclosure" or the estimate of a "quadrature", and
`provenance_of(scene)` where the formula comes from. The first that covers a scene solves it, or says what it cannot do.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from types import ModuleType

import numpy as np
from flint import arb, ctx

from lightproof.certify import (
    ball_seen,
    coaxial_disks,
    concentric,
    direct,
    enclosure,
    one_reflection,
    perpendicular,
    pictures,
    solid_angle,
    sphere_interior,
)
from lightproof.certify.balls import PRECISION, CannotCertify, Element, Undecided, exact
from lightproof.scene import PointsFilm, Scene

MOST_PRECISION = 4096  # bits
NARROW = 60  # bits of a value at a point that a ball has to give
SOLVERS: tuple[ModuleType, ...] = (sphere_interior, concentric, enclosure, ball_seen, pictures, coaxial_disks, one_reflection,
                                    perpendicular, solid_angle, direct)


@dataclass(frozen=True)
class Certified:
    """`value` and `uncertainty` (m,) of m film elements, in the film's unit: the true value is within `uncertainty` of `value`,
    the nearest binary64 included. `engine` names the solver; `kind` is "enclosure" where that is proven, "quadrature" where it
    is estimated."""

    value: np.ndarray
    uncertainty: np.ndarray
    engine: str
    kind: str


def solver(scene: Scene) -> ModuleType:
    """The module that knows a scene. Raises CannotCertify where none does."""
    for module in SOLVERS:
        if module.covers(scene):
            return module
    raise CannotCertify(f"films of {scene.film.quantity.replace('_', ' ')} are not covered")


def certify(scene: Scene, elements: Iterable[int] | None = None, progress: Callable[[], None] = lambda: None) -> Certified:
    """Proven values of the film, or of the elements asked for; `progress` is called after each. Raises CannotCertify."""
    scene = scene.tangible
    module = solver(scene)
    solution = cache(lambda bits: module.solve(scene))  # at each working precision anew
    narrow = NARROW if isinstance(scene.film, PointsFilm) else 0
    pairs = []
    for index in range(scene.size) if elements is None else elements:
        pairs.append(_settled(solution, index, narrow))
        progress()
    value, uncertainty = np.array(pairs).reshape(-1, 2).T
    name = module.__name__.rpartition(".")[2].replace("_", "-")
    return Certified(value, uncertainty, f"certify/{name}", module.kind(scene))


def _settled(solution: Callable[[int], Element], index: int, narrow: int, bits: int = PRECISION,
             width: float | arb = math.inf) -> tuple[float, float]:
    """An element's value and bound at the first precision, of `bits` or more, that gives `narrow` bits of the value, or that
    gives no ball much narrower than the `width` of the one before. Raises CannotCertify."""
    with ctx.workprec(bits):
        try:
            ball = arb(solution(bits)(index))
        except Undecided:
            if bits >= MOST_PRECISION:
                raise
            ball = arb("nan")
        settled = ball.is_exact() or ball.rel_accuracy_bits() >= narrow or ball.rad() > width / 2
        if bits >= MOST_PRECISION or (ball.is_finite() and settled):
            return _rounded(ball)
    return _settled(solution, index, narrow, 2 * bits, ball.rad())


def _rounded(ball: arb) -> tuple[float, float]:
    """The nearest binary64 to a ball's middle, and a bound on how far the true value is from it, itself rounded up."""
    ball = arb(ball)
    if not ball.is_finite():
        raise CannotCertify("the formula is singular at some receiver: in line with an edge, or on a light")
    value = float(ball.mid()) + 0.0  # 0, not -0
    if math.isinf(value):
        raise CannotCertify("a value exceeds what a binary64 can hold; give less light or smaller lengths")
    error = (ball - exact(value)).abs_upper()
    return value, float(np.nextafter(float(error), np.inf)) if error > 0 else 0.0
