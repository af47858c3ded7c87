"""Diffuse paths with next-event estimation: lights are sampled point by point, surfaces that glow and skies are met by
directions drawn in proportion to the cosine. A path ends by roulette that keeps its expectation (Arvo and Kirk 1990)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from lightproof.estimators.compiled import strict, strict_kernel
from lightproof.estimators.directions import cosine_power, oriented
from lightproof.estimators.lighting import direct
from lightproof.estimators.rng import mix64, stream, uniform
from lightproof.estimators.tracing import front_normal, nearest, receive, sky_radiance
from lightproof.estimators.vectors import along, dot
from lightproof.estimators.world import LAMP, RADIANCE, RECEIVER, REFLECTANCE, SAMPLED, World, build
from lightproof.scene import Scene

FAINT = 0.05  # share of a path's first weight below which roulette plays
SURVIVAL = 0.95  # the highest chance of going on once it does
ENDLESS = 2**31 - 1


@strict
def arriving(items, skies, bulbs, x, n, bounces, glow, key, contact):
    """Estimate of the irradiance at x after up to `bounces` reflections [W/m2]."""
    total, weight = 0.0, 1.0
    while True:
        key = mix64(key)
        total += weight * direct(items, bulbs, x, n, mix64(key ^ np.uint64(1)), contact)
        if bounces == 0 and not glow:
            return total
        w = oriented(cosine_power(1, uniform(key, 0), uniform(key, 1)), n)
        i, t = nearest(items, x, w, contact)
        if i < 0:
            return total + weight * math.pi * sky_radiance(skies, w)
        x = along(x, t, w)
        n = front_normal(items[i], x)
        if dot(n, w) >= 0 or items[i, LAMP] != 0:
            return total
        total += weight * math.pi * items[i, RADIANCE]
        weight *= items[i, REFLECTANCE]
        bounces -= 1
        survival = min(items[i, REFLECTANCE], SURVIVAL) if weight < FAINT else 1.0
        if bounces < 0 or uniform(key, 2) >= survival:
            return total
        weight /= survival


@strict_kernel
def estimate(items, skies, bulbs, film, elements, contact, first, seed, samples, bounces, glow, out):
    """Sums of the value and of its square over samples `samples[0]` to `samples[1]` of each of `elements`; `out` (n, 2).
    Light of up to `bounces` reflections; `glow`: whether there is light that only a direction can meet."""
    for e in range(len(elements)):
        total, square = 0.0, 0.0
        for i in range(samples[0], samples[1]):
            key = stream(seed, first + e, i)
            p, q = uniform(key, 0) - 0.5, uniform(key, 1) - 0.5
            value, factor, x, n = receive(items, skies, film, elements[e], p, q, contact)
            left = bounces if film == RECEIVER else bounces - 1
            if factor > 0 and left >= 0:
                value += factor * arriving(items, skies, bulbs, x, n, left, glow, mix64(key), contact)
            total += value
            square += value * value
        out[e, 0], out[e, 1] = total, square


@dataclass(frozen=True)
class Paths:
    """A scene as the kernel takes it. `glow`: whether some light is met by directions and not sampled point by point."""

    world: World
    bounces: int
    glow: bool

    def add(self, first: int, last: int, samples: tuple[int, int], seed: int, out: np.ndarray) -> None:
        """Sums over samples `samples[0]` to `samples[1]` of elements `first` to `last`, into `out` (last - first, 2)."""
        items, skies, bulbs, film, elements, contact = self.world.arrays
        estimate(items, skies, bulbs, film, elements[first:last], contact, first, seed, samples, self.bounces, self.glow, out)


def paths(scene: Scene, aim: bool = True) -> Paths:
    """A scene's paths with all the reflections that it asks for; without `aim` no light is sampled point by point: like
    surfaces that glow, all are met."""
    world = build(scene, sample_surfaces=False)
    if not aim:
        world.items[:, [SAMPLED, LAMP]] = 0
    glowing = (world.items[:, RADIANCE] > 0) & (world.items[:, SAMPLED] == 0)
    bounces = 0 if not scene.reflects else ENDLESS if scene.max_bounces == "all" else scene.max_bounces
    return Paths(world, bounces, bool(len(world.skies) or glowing.any()))
