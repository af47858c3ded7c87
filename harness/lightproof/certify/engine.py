"""The first engine: from a scene to proven values."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from flint import arb, ctx

from lightproof.certify import coaxial, direct, floor_seen, sphere_interior
from lightproof.certify.balls import PRECISION, CannotCertify, Element, exact
from lightproof.scene import CameraFilm, Scene

SOLVERS: dict[str, Callable[[Scene], Element]] = {
    "sphere-interior": sphere_interior.solve,
    "floor-seen": floor_seen.solve,
    "coaxial-disks": coaxial.solve,
    "direct": direct.solve,
}


@dataclass(frozen=True)
class Certified:
    """`value` and `uncertainty` (m,) of m film elements, in the film's unit: the true value is within `uncertainty` of `value`,
    the nearest binary64 included. `engine` names the solver."""

    value: np.ndarray
    uncertainty: np.ndarray
    engine: str


def solver(scene: Scene) -> str:
    """The name of the solver for a scene."""
    if sphere_interior.covers(scene):
        return "sphere-interior"
    if isinstance(scene.film, CameraFilm):
        return "floor-seen"
    return "coaxial-disks" if coaxial.covers(scene) else "direct"


def certify(scene: Scene, elements: Iterable[int] | None = None, progress: Callable[[], None] = lambda: None) -> Certified:
    """Proven values of the film, or of the elements asked for; `progress` is called after each. Raises CannotCertify."""
    name = solver(scene)
    if scene.film.quantity == "solid_angle":
        raise CannotCertify("films of solid angle are not covered")
    with ctx.workprec(PRECISION):
        element = SOLVERS[name](scene)
        pairs = []
        for index in range(scene.size) if elements is None else elements:
            pairs.append(_rounded(element(index)))
            progress()
    value, uncertainty = np.array(pairs).reshape(-1, 2).T
    return Certified(value, uncertainty, f"certify/{name}")


def _rounded(ball: arb) -> tuple[float, float]:
    """The nearest binary64 to a ball's middle, and a bound on how far the true value is from it, itself rounded up."""
    ball = arb(ball)
    if not ball.is_finite():
        raise CannotCertify("the formula is singular at some receiver: in line with an edge, or on a light")
    value = float(ball.mid())
    error = (ball - exact(value)).abs_upper()
    return value, float(np.nextafter(float(error), np.inf)) if error > 0 else 0.0
