"""What the modules that know one kind of light give `direct`: the light's irradiance on one side of a plane."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from flint import arb

from lightproof import geometry
from lightproof.certify.balls import Point
from lightproof.certify.emitters import Formula
from lightproof.certify.planes import Frame, Plane, Region

Shape = geometry.Shape


@dataclass(frozen=True)
class Field:
    """Irradiance on one side of a plane from one light: `near(point)` is the formula that holds around a point of the plane,
    up to the next of the planes `events`, where the light's visible shape changes (None: across curved surfaces too). `flux`,
    where it is given, is the integral over a convex region of film positions, found in a better way."""

    near: Callable[[Point], Formula]
    events: tuple[Plane, ...] | None = ()
    flux: Callable[[Frame, Region], arb] | None = None
