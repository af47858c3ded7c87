"""Lights as directions uniform in their solid angle find them, by `towards` in `fans` and `cones`."""

from __future__ import annotations

from numba.extending import overload

from lightproof.estimators.aims import INLINED, Aim, counted
from lightproof.estimators.cones import towards
from lightproof.estimators.rng import TICK
from lightproof.estimators.vectors import scaled


class Subtended(Aim):
    """An aim at a light's solid angle."""

    __slots__ = ()


@overload(counted, jit_options=INLINED)
def _counted(lamp, x, s, t):
    return counted_subtended if lamp.instance_class is Subtended else None


def counted_subtended(lamp, x, s, t):
    per_density, w, distance = towards(lamp.shape, lamp.level, x, s * TICK + 0.5, t * TICK + 0.5)
    return per_density * max(w[2], 0.0), scaled(distance, w)
