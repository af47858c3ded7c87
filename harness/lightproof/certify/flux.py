"""Integrals over convex parts of a plane film."""

from __future__ import annotations

from flint import arb

from lightproof.certify import planes, quadrature
from lightproof.certify.balls import Ball
from lightproof.certify.emitters import Formula
from lightproof.certify.planes import Frame, Patch, Region


def through(frame: Frame, region: Region, formula: Formula, scale: arb | None = None) -> arb:
    """The integral of a formula over film positions of a region all over which it holds; an error of less than about 2^-58 of
    `scale`, of its own size unless given, is aimed at. Raises CannotCertify."""
    return sum((_over(frame, patch, formula, scale) for patch in planes.patches(region)), arb(0))


def _over(frame: Frame, patch: Patch, formula: Formula, scale: arb | None) -> arb:
    def integrand(s: Ball, t: Ball) -> Ball:
        return patch.jacobian(s, t) * formula(frame.at(*patch.at(s, t)))

    return quadrature.integral(integrand, None if scale is None else scale / 4)
