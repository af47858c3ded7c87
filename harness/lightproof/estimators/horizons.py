"""Lights that a receiver's horizon cuts: how little is left of one, heights in float32 do not tell."""

from __future__ import annotations

import numpy as np

from lightproof.estimators.elements import CENTER, NORMAL
from lightproof.estimators.extents import CONTACT
from lightproof.estimators.shapes import Flat, Sphere, support
from lightproof.estimators.views import View


def cut(shape: Flat | Sphere, view: View) -> bool:
    """Whether a light lies on both sides of the plane of any receiver."""
    rows = view.receivers[:1] if view.plane else view.receivers
    level = (rows[:, CENTER] * rows[:, NORMAL]).sum(axis=1)
    highest, lowest = support(shape, rows[:, NORMAL]) - level, -support(shape, -rows[:, NORMAL]) - level
    return bool(((highest > 0) & (lowest < -CONTACT * (np.abs(level) + np.abs(shape.center).max()))).any())
