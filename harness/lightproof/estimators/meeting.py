"""Lights as directions meet them: one direction of the receiver's hemisphere per draw, with density per solid angle.

The same protocol as in `lamps`: `arriving(source, x, s, t)` gives L cos(theta) / pdf_solid_angle per strength, L being the
light's own (its fronts shine, a sky always does), and the vector from x to the point met.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators.compiled import fast
from lightproof.estimators.lamps import arriving, faced
from lightproof.estimators.rng import TICK
from lightproof.estimators.shapes import Flat, Sphere, covers, placed
from lightproof.estimators.skies import Dome, placed_dome, sky_radiances
from lightproof.estimators.trigonometry import turn
from lightproof.estimators.vectors import dot, like, scaled, sub

GRAZING = 1e-12  # cosines below count as none: a ray along a plane does not meet it


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
    return lambda light, origin, frame, model: placed(light, origin, frame, model)


@overload(arriving)
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


@overload(meet)
def _meet(light, x, w):
    return {Sphere: _meet_sphere, Dome: _meet_dome}.get(light.instance_class, _meet_flat)


def _meet_flat(light, x, w):
    o = sub(x, light.center)
    above, approach = dot(o, light.normal), -dot(w, light.normal)
    d = scaled(above / max(approach, like(above, GRAZING)), w)
    a, b = dot(o, light.dual_u) + dot(d, light.dual_u), dot(o, light.dual_v) + dot(d, light.dual_v)
    facing = (above > like(above, 0)) & (approach > like(above, GRAZING))
    return like(above, 1) if facing & covers(light, a, b) else like(above, 0), d


def _meet_sphere(light, x, w):
    """From outside; `foot` leads from the ray's nearest point to the centre."""
    o = sub(light.center, x)
    reach = dot(o, w)
    foot = sub(o, scaled(reach, w))
    zero = like(reach, 0)
    rest = light.radius * light.radius - dot(foot, foot)
    d = scaled(reach - math.sqrt(max(rest, zero)), w)
    outside = dot(o, o) > light.radius * light.radius
    return like(reach, 1) if (rest > zero) & (reach > zero) & outside else zero, d


def _meet_dome(light, x, w):
    return sky_radiances(light.skies, w), scaled(light.reach, w)
