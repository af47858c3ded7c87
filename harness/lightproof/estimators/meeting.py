"""Lights as directions meet them: one direction of the receiver's hemisphere per draw, with density per solid angle.

The same protocol as in `lamps`: `arriving(source, x, s, t)` gives L cos(theta) / pdf_solid_angle per strength, L being the
light's own (its fronts shine, a sky always does), and the vector from x to the point met.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.compiled import INLINED, fast
from lightproof.estimators.lamps import arriving, faced, level_from, level_of
from lightproof.estimators.rng import TICK
from lightproof.estimators.shapes import Flat, Sphere, placed
from lightproof.estimators.skies import Dome, placed_dome, sky_radiances
from lightproof.estimators.trigonometry import turn
from lightproof.estimators.vectors import dot, like, scaled, sub
from lightproof.estimators.windows import Window, window, within

GRAZING = 1e-12  # cosines below count as none: a ray along a plane does not meet it


class Ball(NamedTuple):
    """A sphere as directions meet it from an element; `level` [m2] is as in `lamps.Facing`."""

    shape: Sphere
    level: float


class Uniform(NamedTuple):
    """A light of radiance `strength`, or the dome of all skies (`strength` 1), met by directions uniform in solid angle."""

    light: Flat | Sphere | Dome
    strength: float


class Cosine(NamedTuple):
    """The same met by directions of density cos(theta)/pi."""

    light: Flat | Sphere | Dome
    strength: float


@overload(faced)
def _faced(lamp, origin, frame, model):
    return FACED.get(lamp.instance_class)


def _faced_source(kind):
    def face(lamp, origin, frame, model):
        return kind(light_placed(lamp.light, origin, frame, model), like(model, lamp.strength))

    return face


FACED = {kind: _faced_source(kind) for kind in (Uniform, Cosine)}


def light_placed(light, origin, frame, model):
    """The light as seen from `origin` along the axes of `frame`, in the precision of `model`."""


@overload(light_placed)
def _light_placed(light, origin, frame, model):
    if light.instance_class is Dome:
        return lambda light, origin, frame, model: placed_dome(light, frame, model)
    if light.instance_class is Sphere:
        return ball
    return lambda light, origin, frame, model: window(light, origin, frame, model)


def ball(light, origin, frame, model):
    return Ball(placed(light, origin, frame, model), like(model, level_of(light, sub(origin, light.center))))


@overload(arriving, jit_options=INLINED)
def _arriving(lamp, x, s, t):
    return {Uniform: _arriving_uniform, Cosine: _arriving_cosine}.get(lamp.instance_class)


def _arriving_uniform(lamp, x, s, t):
    """Archimedes: the height above the receiver's plane is uniform."""
    down = s * like(s, TICK) + like(s, 0.5)
    w = around(like(s, 1) - down, down * (like(s, 2) - down), t)
    met, d = meet(lamp.light, x, w)
    return like(s, 2 * np.pi) * w[2] * met, d


def _arriving_cosine(lamp, x, s, t):
    """Malley: uniform in the unit circle below."""
    down = s * like(s, TICK) + like(s, 0.5)
    met, d = meet(lamp.light, x, around(math.sqrt(max(like(s, 1) - down, like(s, 0))), down, t))
    return like(s, np.pi) * met, d


@fast
def around(height, radius2, t):
    """The unit vector at `height` over a circle of squared radius `radius2`, TICK t turns about the third axis."""
    radius = math.sqrt(max(radius2, like(t, 0)))
    sine, cosine = turn(t)
    return radius * cosine, radius * sine, height


def meet(light, x, w):
    """Radiance per strength that x sees of the light in direction w, a unit vector, and the vector to the point met."""


@overload(meet, jit_options=INLINED)
def _meet(light, x, w):
    return {Ball: _meet_ball, Dome: _meet_dome, Window: _meet_window}[light.instance_class]


def _meet_window(light, x, w):
    shape = light.shape
    above, approach = dot(x, shape.normal) + light.level, -dot(w, shape.normal)
    d = scaled(above / max(approach, like(above, GRAZING)), w)
    a, b = dot(x, shape.dual_u) + dot(d, shape.dual_u), dot(x, shape.dual_v) + dot(d, shape.dual_v)
    facing = (above > like(above, 0)) & (approach > like(above, GRAZING))
    return like(above, 1) if facing & within(shape, light.margins, a, b, like(above, 1)) else like(above, 0), d


def _meet_ball(light, x, w):
    return met(light.shape, level_from(light, x), x, w)


@fast
def met(sphere, level, x, w):
    """From outside, where `level` is positive; `foot` leads from the ray's nearest point to the centre. The square of half the
    chord is R^2 - foot^2, or from nearby, where those are almost the same, reach^2 - level."""
    o = sub(sphere.center, x)
    reach = dot(o, w)
    foot = sub(o, scaled(reach, w))
    zero, square = like(reach, 0), sphere.radius * sphere.radius
    rest = reach * reach - level if level < square else square - dot(foot, foot)
    ahead = (rest > zero) & (reach > zero) & (level > zero)
    d = scaled(level / max(reach + math.sqrt(max(rest, zero)), like(reach, GRAZING)), w)
    return like(reach, 1) if ahead else zero, d


def _meet_dome(light, x, w):
    return sky_radiances(light.skies, w), scaled(light.reach, w)
