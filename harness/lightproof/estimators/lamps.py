"""Lights as the fast kernel samples them: one point of the light per draw, with density per area.

`arriving(lamp, x, s, t)` gives the estimate of irradiance at `x`, whose normal is the third axis, per strength of the
lamp, from two draws s, t (in units of TICK), and the vector from `x` to the light's point:
L cos(theta_x) cos(theta_y) / (r^2 p), with cosines written as dot products with the unnormalised d = y - x.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof import geometry
from lightproof import scene as scenes
from lightproof.estimators import shapes
from lightproof.estimators.compiled import INLINED, inlined, strict
from lightproof.estimators.rng import TICK
from lightproof.estimators.shapes import Disk, Flat, Parallelogram, Sphere, Triangle, placed
from lightproof.estimators.trigonometry import turn
from lightproof.estimators.vectors import along, dot, like, product, scaled, sub, tangents, turned
from lightproof.estimators.windows import height
from lightproof.geometry import Vec3

LEAST = 1e-37  # square of a length [m2]: what is left of smaller ones in float32 is no number


class Glow(NamedTuple):
    """One piece of a light: the light's id, the piece, its radiance [W/(m2 sr)], and of a polygon its corners (k, 3) as the scene
    has them, which `shape` repeats but for 1e-12 of its size."""

    owner: str
    shape: Flat | Sphere
    radiance: float
    corners: np.ndarray | None = None


class Lamp(NamedTuple):
    """A shape that emits from its front. `strength`: radiance over density per area [W/sr]; of a sphere, the radiance."""

    shape: Flat | Sphere
    strength: float


class Tile(NamedTuple):
    """A parallelogram's center + s u + t v with draws s and t in units of TICK, which its sides hold already."""

    center: Vec3
    u: Vec3
    v: Vec3
    normal: Vec3


class Facing(NamedTuple):
    """A lamp as seen from an element. `level` is what turned coordinates could not tell from the rest: the element's height over
    the plane of a flat shape [m], or the square of its distance from a sphere's centre less that of the radius [m2]."""

    shape: Tile | Flat | Sphere
    strength: float
    level: float


class Point(NamedTuple):
    """A point of `strength` [W/sr], the same in every direction."""

    position: Vec3
    strength: float


class Beam(NamedTuple):
    """A collimated beam; `back` runs against it, beyond everything in the scene; `strength` is its irradiance [W/m2]."""

    back: Vec3
    strength: float


def bulbs(scene: scenes.Scene, reach: float) -> list[tuple[str, Point | Beam]]:
    """Every light of a scene without an area, but skies, with its id; `reach` [m] leads out of the scene."""
    found: list[tuple[str, Point | Beam]] = []
    for light in scene.lights:
        match light:
            case scenes.PointLight():
                found.append((light.id, Point(light.position, light.intensity)))
            case scenes.DirectionalLight():
                back = -reach * geometry.unit(light.direction)
                found.append((light.id, Beam(tuple(back.tolist()), light.irradiance)))
    return found


def glowing(scene: scenes.Scene) -> list[Glow]:
    """Every piece of every light with an area; surfaces that emit are lights. A piece whose area is zero emits nothing."""
    lights = [light for light in scene.lights if isinstance(light, scenes.AreaLight)]
    lights += [surface for surface in scene.surfaces if surface.radiance]
    pieces = [Glow(light.id, shape, light.radiance, corners)
              for light in lights for shape, corners in shapes.cornered(light.shape)]
    return [piece for piece in pieces if shapes.area(piece.shape) > 0]


def lamp(glow: Glow) -> Lamp:
    """The piece, to be found by its points."""
    return Lamp(glow.shape, glow.radiance * (1 if isinstance(glow.shape, Sphere) else shapes.area(glow.shape)))


def faced(lamp, origin, frame, model):
    """The lamp as seen from `origin` along the axes of `frame`, in the precision of `model`."""


@overload(faced)
def _faced(lamp, origin, frame, model):
    return FACED.get(lamp.instance_class)


def _faced_lamp(lamp, origin, frame, model):
    level = like(model, level_of(lamp.shape, sub(origin, lamp.shape.center)))
    return Facing(drawable(placed(lamp.shape, origin, frame, model)), like(model, lamp.strength), level)


def level_of(shape, w):
    """The `level` of what lies at `w` from the shape's centre, in float64."""


@overload(level_of)
def _level_of(shape, w):
    if shape.instance_class is Sphere:
        return lambda shape, w: beyond(shape.radius, w)
    return lambda shape, w: height(shape, w)


@strict
def beyond(radius, w):
    """w^2 - R^2, the largest component by itself, so that nothing cancels along an axis."""
    a, b, c = abs(w[0]), abs(w[1]), abs(w[2])
    most, least = max(a, b, c), min(a, b, c)
    middle = max(min(a, b), min(max(a, b), c))
    return (most - radius) * (most + radius) + middle * middle + least * least


@inlined
def level_from(ball, x):
    """The `level` of a sphere from x instead of the element's origin."""
    center = ball.shape.center
    return ball.level + dot(x, sub(sub(x, center), center))


def drawable(shape):
    """The shape as `parameters` are drawn for it the cheapest."""


@overload(drawable)
def _drawable(shape):
    return tile if shape.instance_class is Parallelogram else lambda shape: shape


def tile(shape):
    tick = like(shape.u[0], TICK)
    return Tile(shape.center, scaled(tick, shape.u), scaled(tick, shape.v), shape.normal)


def _faced_point(lamp, origin, frame, model):
    return Point(turned(sub(lamp.position, origin), frame, model), like(model, lamp.strength))


def _faced_beam(lamp, origin, frame, model):
    return Beam(turned(lamp.back, frame, model), like(model, lamp.strength))


FACED = {Lamp: _faced_lamp, Point: _faced_point, Beam: _faced_beam}


def arriving(lamp, x, s, t):
    """Estimate of irradiance per strength at `x` without blockers, and the vector to the light's point; see the module."""


@overload(arriving, jit_options=INLINED)
def _arriving(lamp, x, s, t):
    if lamp.instance_class is Facing:
        return _arriving_sphere if lamp.types[0].instance_class is Sphere else _arriving_flat
    return {Point: _arriving_point, Beam: _arriving_beam}.get(lamp.instance_class)


def _arriving_flat(lamp, x, s, t):
    a, b = parameters(lamp.shape, s, t)
    d = sub(along(along(lamp.shape.center, a, lamp.shape.u), b, lamp.shape.v), x)
    zero, inverse = like(x[0], 0), like(x[0], 1) / dot(d, d)
    before = dot(x, lamp.shape.normal) + lamp.level
    return product(max(d[2], zero) * inverse, max(before, zero) * inverse), d


def _arriving_sphere(lamp, x, s, t):
    """A point uniform on the cap of the sphere that faces x, of area 2 pi R^2 (1 - R/r); black from inside. A share u of the way
    down the cap, d = R side - (R u h + gap) axis and -d . n = gap (1 - u), gap = r - R and h = gap/r: nothing cancels."""
    w, radius = sub(x, lamp.shape.center), lamp.shape.radius
    r = math.sqrt(dot(w, w))
    zero, one = like(r, 0), like(r, 1)
    gap = max(level_from(lamp, x), zero) / (r + radius)
    u = s * like(s, TICK) + like(s, 0.5)
    inverse = one / r
    height = gap * inverse
    down = u * height
    side = radius * math.sqrt(max(down * (like(s, 2) - down), zero))
    axis = scaled(inverse, w)
    e1, e2 = tangents(axis)
    sine, cosine = turn(t)
    d = along(along(scaled(-(radius * down + gap), axis), side * cosine, e1), side * sine, e2)
    per = one / max(dot(d, d), like(s, LEAST))
    cap = like(s, 2 * np.pi) * radius * radius * height
    return cap * product(max(d[2], zero) * per, gap * max(one - u, zero) * per), d


def _arriving_point(lamp, x, s, t):
    d = sub(lamp.position, x)
    r2 = dot(d, d)
    return max(d[2], like(r2, 0)) / (r2 * math.sqrt(r2)), d


def _arriving_beam(lamp, x, s, t):
    return max(lamp.back[2], like(s, 0)) / math.sqrt(dot(lamp.back, lamp.back)), lamp.back


def parameters(shape, s, t):
    """A point uniform over the parameters of a flat shape, from two draws in units of TICK."""


@overload(parameters)
def _parameters(shape, s, t):
    return {Tile: _in_tile, Parallelogram: _in_square, Triangle: _in_triangle, Disk: _in_circle}[shape.instance_class]


def _in_tile(shape, s, t):
    return s, t


def _in_square(shape, s, t):
    return s * like(s, TICK), t * like(s, TICK)


def _in_triangle(shape, s, t):
    """Uniform in the unit square, the upper half folded onto the lower."""
    a, b = s * like(s, TICK), t * like(s, TICK)
    fold = like(s, 1) if a + b <= like(s, 0) else like(s, -1)
    return like(s, 0.5) + fold * a, like(s, 0.5) + fold * b


def _in_circle(shape, s, t):
    radius = math.sqrt(max(s * like(s, TICK) + like(s, 0.5), like(s, 0)))
    sine, cosine = turn(t)
    return radius * cosine, radius * sine
