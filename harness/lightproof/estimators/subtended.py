"""Lights as directions uniform in their solid angle find them, by `towards` in `fans` and `cones`."""

from __future__ import annotations

from numba.extending import overload

from lightproof.estimators.aims import Aim, beheld, counted
from lightproof.estimators.compiled import INLINED
from lightproof.estimators.cones import towards
from lightproof.estimators.outlines import outlined
from lightproof.estimators.rng import TICK
from lightproof.estimators.vectors import scaled


class Subtended(Aim):
    """An aim at a light's solid angle."""

    __slots__ = ()


@overload(beheld)
def _beheld(lamp, origin, frame):
    if lamp.instance_class is Subtended:
        return lambda lamp, origin, frame: outlined(lamp.shape, lamp.corners, origin, frame)


@overload(counted, jit_options=INLINED)
def _counted(lamp, x, s, t):
    return counted_subtended if lamp.instance_class is Subtended else None


def counted_subtended(lamp, x, s, t):
    per_density, w, distance = towards(lamp.shape, x, s * TICK + 0.5, t * TICK + 0.5)
    return per_density * max(w[2], 0.0), scaled(distance, w)
