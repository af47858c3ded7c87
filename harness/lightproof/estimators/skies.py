"""Skies as compiled code wants them: named tuples dispatched on by type, all skies of a scene together in one dome.

Each holds a direction (`up`, or that in which the sun stands), which turns into the receiver's frame.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba.extending import overload

from lightproof import geometry
from lightproof import scene as scenes
from lightproof.estimators.vectors import dot, like, scaled, sub, turned
from lightproof.geometry import Vec3

UP = (0.0, 0.0, 1.0)


class Everywhere(NamedTuple):
    """The same radiance from all directions."""

    up: Vec3
    radiance: float


class Upper(NamedTuple):
    """The same radiance from above, black below."""

    up: Vec3
    radiance: float


class Overcast(NamedTuple):
    """The CIE's standard: `radiance` (1 + 2 sin(elevation))/3, black below."""

    up: Vec3
    radiance: float


class Sun(NamedTuple):
    """Radiance around a direction, up to an angle whose squared sine is `sine2`: the cosine of a small one has no digits."""

    up: Vec3
    radiance: float
    sine2: float


Sky = Everywhere | Upper | Overcast | Sun


class Dome(NamedTuple):
    """All skies, beyond everything: `reach` [m] leads out of the scene."""

    skies: tuple[Sky, ...]
    reach: float


def dome(scene: scenes.Scene, reach: float) -> Dome | None:
    """The skies of a scene; None where it has none."""
    found = tuple(one for light in scene.lights if (one := sky(light)))
    return Dome(found, reach) if found else None


def sky(light: scenes.Light) -> Sky | None:
    match light:
        case scenes.Environment():
            return (Everywhere if light.extent == "sphere" else Upper)(UP, light.radiance)
        case scenes.OvercastSky():
            return Overcast(UP, light.zenith_radiance)
        case scenes.SunDisc():
            towards = tuple((-geometry.unit(light.direction)).tolist())
            return Sun(towards, light.radiance, math.sin(math.radians(light.half_angle)) ** 2)
    return None


def placed_dome(dome, frame, model):
    """The dome along the axes of `frame`, in the precision of `model`."""


@overload(placed_dome)
def _placed_dome(dome, frame, model):
    return lambda dome, frame, model: Dome(placed_skies(dome.skies, frame, model), like(model, dome.reach))


def placed_skies(skies, frame, model):
    """A tuple of skies along the axes of `frame`."""


@overload(placed_skies)
def _placed_skies(skies, frame, model):
    if len(skies) == 0:
        return lambda skies, frame, model: ()
    return lambda skies, frame, model: (placed_sky(skies[0], frame, model), *placed_skies(skies[1:], frame, model))


def placed_sky(sky, frame, model):
    """One sky along the axes of `frame`."""


@overload(placed_sky)
def _placed_sky(sky, frame, model):
    return PLACED[sky.instance_class]


def _turned_sky(kind):
    return lambda sky, frame, model: kind(turned(sky.up, frame, model), like(model, sky.radiance))


def _turned_sun(sky, frame, model):
    return Sun(turned(sky.up, frame, model), like(model, sky.radiance), like(model, sky.sine2))


PLACED = {Sun: _turned_sun, **{kind: _turned_sky(kind) for kind in (Everywhere, Upper, Overcast)}}


def sky_radiances(skies, w):
    """Radiance of a tuple of skies from direction w."""


@overload(sky_radiances)
def _sky_radiances(skies, w):
    if len(skies) == 0:
        return lambda skies, w: like(w[0], 0)
    return lambda skies, w: sky_radiance(skies[0], w) + sky_radiances(skies[1:], w)


def sky_radiance(sky, w):
    """Radiance of one sky from direction w."""


@overload(sky_radiance)
def _sky_radiance(sky, w):
    return {Everywhere: _of_everywhere, Upper: _of_upper, Overcast: _of_overcast, Sun: _of_sun}[sky.instance_class]


def _of_everywhere(sky, w):
    return sky.radiance


def _of_upper(sky, w):
    return sky.radiance if dot(w, sky.up) > like(w[0], 0) else like(w[0], 0)


def _of_overcast(sky, w):
    sine = dot(w, sky.up)
    return sky.radiance * (like(sine, 1) + like(sine, 2) * sine) / like(sine, 3) if sine > like(sine, 0) else like(sine, 0)


def _of_sun(sky, w):
    cosine = dot(w, sky.up)
    aside = sub(w, scaled(cosine, sky.up))
    within = (cosine > like(cosine, 0)) & (dot(aside, aside) <= sky.sine2)
    return sky.radiance if within else like(cosine, 0)
