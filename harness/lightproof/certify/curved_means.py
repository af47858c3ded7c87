"""Means of irradiance over parts of a plane film behind curved blockers: estimates, from many receivers in binary64.

The point engine, whose values are proven, is asked for one receiver of each part; if the two differ, the scene is refused.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from flint import arb

from lightproof import geometry
from lightproof.certify import cubature, parting, planes
from lightproof.certify.balls import CannotCertify, Point, exact
from lightproof.certify.emitters import Formula
from lightproof.certify.many_outlines import Array, floats, irradiance
from lightproof.certify.parting import Solid
from lightproof.certify.planes import Frame, Patch, Region

GOAL = 2e-10  # of what the open light gives
SAME = 1e-11  # of it: as far as binary64 may be from the proven value
CENTRE = np.zeros((2, 1))
ASIDE = np.array([[0.27], [-0.14]])  # in the square: the receiver that is checked


@dataclass(frozen=True)
class Means:
    """The flux of a light past blockers, `near` being its irradiance at points."""

    lamp: Solid
    blockers: Sequence[Solid]
    radiance: float
    near: Callable[[Point], Formula]

    def flux(self, frame: Frame, region: Region) -> arb:
        """The integral of irradiance over film positions of a convex region. Raises CannotCertify."""
        corners = [frame.at(*position) for position in region]
        nearer = [shape for shape in self.blockers if self._hides(shape, corners)]
        return sum((self._over(frame, patch, nearer) for patch in planes.patches(region)), arb(0))

    def _hides(self, blocker: Solid, corners: Sequence[Point]) -> bool:
        answers = {parting.in_front(blocker, self.lamp, corner) for corner in corners}
        if len(answers) > 1 or None in answers:
            raise CannotCertify("no plane that was tried passes between a light and a blocker, for all receivers of an element")
        return answers.pop()

    def _over(self, frame: Frame, patch: Patch, nearer: Sequence[Solid]) -> arb:
        stretch = Stretch.of(frame, patch)
        scale = irradiance(self.lamp, (), stretch.at(*CENTRE), stretch.normal)[0]
        self._check(frame, patch, nearer, SAME * scale)
        value, uncertainty = cubature.integral(
            lambda s, t: irradiance(self.lamp, nearer, stretch.at(s, t), stretch.normal) * stretch.jacobian(s, t),
            GOAL * scale * stretch.area)
        return exact(self.radiance) * arb(value, uncertainty + SAME * scale * stretch.area)

    def _check(self, frame: Frame, patch: Patch, nearer: Sequence[Solid], slack: float) -> None:
        stretch = Stretch.of(frame, patch)
        position = stretch.position(*ASIDE)
        x = frame.at(*map(exact, position[0]))
        proven = float(arb(self.near(x)(x)).mid())
        value = irradiance(self.lamp, nearer, stretch.at(*ASIDE), stretch.normal)[0]
        if not abs(proven - self.radiance * value) <= self.radiance * slack:
            raise CannotCertify("outlines that coincide as the film sees them are covered at points only")


@dataclass(frozen=True)
class Stretch:
    """A patch of a film in binary64; `normal` is the film's, of unit length."""

    origin: Array
    u: Array
    v: Array
    normal: Array
    patch: tuple[Array, Array, Array, Array]

    @classmethod
    def of(cls, frame: Frame, patch: Patch) -> Stretch:
        """The patch of a frame."""
        return cls(*map(floats, (frame.origin, frame.u, frame.v)), geometry.unit(floats(frame.plane.normal)),
                   tuple(map(floats, (patch.m, patch.a, patch.b, patch.c))))

    def position(self, s: Array, t: Array) -> Array:
        """Film positions (n, 2)."""
        m, a, b, c = self.patch
        return m + np.outer(s, a) + np.outer(t, b) + np.outer(s * t, c)

    def at(self, s: Array, t: Array) -> Array:
        """Receivers (n, 3)."""
        return self.origin + self.position(s, t) @ [self.u, self.v]

    def jacobian(self, s: Array, t: Array) -> Array:
        """Area in film positions per area of the square, (n,)."""
        _, a, b, c = self.patch
        x, y = a + np.outer(t, c), b + np.outer(s, c)
        return x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]

    @property
    def area(self) -> float:
        """Area in film positions."""
        return 4 * float(self.jacobian(*CENTRE)[0])
