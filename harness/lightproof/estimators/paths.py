"""Diffuse paths with next-event estimation: lights are sampled point by point, surfaces that glow and skies are met by
directions drawn in proportion to the cosine. A path ends by roulette that keeps its expectation (Arvo and Kirk 1990)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import types
from numba.extending import overload

from lightproof.estimators import batch
from lightproof.estimators.aiming import from_bulbs, illuminate
from lightproof.estimators.batch import keep, settle
from lightproof.estimators.compiled import strict_kernel
from lightproof.estimators.points import Random
from lightproof.estimators.recursion import Even, Zoned, reflect
from lightproof.estimators.rng import block_keys, mix64, stream
from lightproof.estimators.rounds import gather_sky, land, play, scatter
from lightproof.estimators.scenery import Scenery, scenery
from lightproof.estimators.sobol import Sobol
from lightproof.estimators.solids import find
from lightproof.estimators.starts import CAMERAS, FILMS, Receivers, Within, begin, sum_up
from lightproof.estimators.world import LAMP, RADIANCE, SAMPLED, World, build
from lightproof.scene import Scene

FAINT, FAINTEST = 0.05, 0.0005  # shares of a path's first weight below which roulette plays: mostly; where it is the only noise
SHORT = 4  # reflections: so few need no roulette
ENDLESS = 2**31 - 1
BEFORE, NEXT = 2**33, 2**34  # numbers of streams, beyond all others: of draws before a path begins, of the next vertex


def look(film, scenery, state, slots, totals, count, key):
    """Follows the rays of a camera, or directions from receivers, to what they meet; how many paths go on. A film that receives
    and begins paths is where it is."""


@overload(look)
def _look(film, scenery, state, slots, totals, count, key):
    if film.instance_class is Receivers:
        return lambda film, scenery, state, slots, totals, count, key: count
    return look_around if film.instance_class is Within else look_ahead


def look_ahead(film, scenery, state, slots, totals, count, key):
    find(scenery.solids, scenery.seen, state, count, 0.0)
    gather_sky(scenery.skies, state, count)
    return keep(state, slots, totals, count, land(state, count))


def look_around(film, scenery, state, slots, totals, count, key):
    from_bulbs(scenery.bulbs, scenery.blockers, state, count, scenery.near)
    scatter(state, count, block_keys(key, BEFORE))
    find(scenery.solids, scenery.met, state, count, scenery.near)
    return keep(state, slots, totals, count, land(state, count))


def follow(recursion, scenery, bounces, glow, faint, state, slots, totals, count, key):
    """Takes all paths to their ends: vertex by vertex, or where there is a recursion at once."""


@overload(follow)
def _follow(recursion, scenery, bounces, glow, faint, state, slots, totals, count, key):
    return walk if isinstance(recursion, types.NoneType) else sum_on


def sum_on(recursion, scenery, bounces, glow, faint, state, slots, totals, count, key):
    if bounces >= 0:
        from_bulbs(scenery.bulbs, scenery.blockers, state, count, scenery.near)
        reflect(recursion, scenery.bulbs, state, count, key, scenery.near)
    settle(state, slots, totals, count)


def walk(recursion, scenery, bounces, glow, faint, state, slots, totals, count, key):
    """`glow`: whether there is light that only a direction can meet."""
    while count > 0 and bounces >= 0:
        key = mix64(key ^ np.uint64(NEXT))
        illuminate(scenery.bulbs, scenery.lamps, scenery.blockers, state, count, key, scenery.near)
        if bounces == 0 and not glow:
            break
        keys = block_keys(key, 0)
        scatter(state, count, keys)
        find(scenery.solids, scenery.met, state, count, scenery.near)
        gather_sky(scenery.skies, state, count)
        going = land(state, count)
        if faint > 0:
            going = play(state, count, keys, faint)
        count = keep(state, slots, totals, count, going)
        bounces -= 1
    settle(state, slots, totals, count)


@strict_kernel
def estimate(film, recursion, scenery, bounces, glow, faint, first, samples, points, out):
    """Sums of the value and of its square over samples `samples[0]` to `samples[1]` of each element of `film`, of which the
    first is number `first`, at places that `points` give; `out` (n, 2). Light of up to `bounces` reflections after a path's first
    vertex, -1: none at it."""
    state, totals = np.empty(batch.ROWS * batch.SIZE), np.empty(batch.SIZE)
    slots = np.empty(batch.SIZE, np.uint32)
    each = samples[1] - samples[0]
    key = stream(points.seed, first, samples[0])
    for number in range(0, each * len(film.rows), batch.SIZE):
        count = min(batch.SIZE, each * len(film.rows) - number)
        own = stream(key, number, 0)
        begin(film, points, state, slots, first, samples, number, count, block_keys(own, 0))
        going = look(film, scenery, state, slots, totals, count, own)
        follow(recursion, scenery, bounces, glow, faint, state, slots, totals, going, own)
        sum_up(totals, number, count, each, out)


@dataclass(frozen=True)
class Paths:
    """A scene as the kernel takes it. `glow`: whether some light is met by directions and not sampled point by point;
    `recursion` ends paths on the wall, on which `inside` says that the film does not lie."""

    world: World
    bounces: int
    glow: bool
    recursion: Even | Zoned | None = None
    inside: bool = False

    def add(self, points: Random | Sobol, first: int, last: int, samples: tuple[int, int], out: np.ndarray) -> None:
        """Sums over samples `samples[0]` to `samples[1]` of elements `first` to `last`, into `out` (last - first, 2)."""
        kind = Within if self.inside else FILMS[self.world.film]
        faint = self.faint / np.pi if kind in CAMERAS else self.faint
        estimate(kind(self.world.elements[first:last]), self.recursion, self.scenery, self.bounces - (kind is not Receivers),
                 self.glow, faint, first, samples, points, out)  # fmt: skip

    @cached_property
    def faint(self) -> float:
        """Share of a path's first weight below which roulette plays."""
        if self.bounces <= SHORT:
            return 0.0
        aimed = self.scenery.lamps or self.scenery.bulbs or self.scenery.skies
        alike = not np.ptp(self.scenery.met[1:, 4:], axis=0).any()  # every hit gives the same
        return FAINTEST if alike and not aimed else FAINT

    @cached_property
    def scenery(self) -> Scenery:
        return scenery(self.world)


def paths(scene: Scene, aim: bool = True) -> Paths:
    """A scene's paths with all the reflections that it asks for; without `aim` no light is sampled point by point: like
    surfaces that glow, all are met."""
    world = build(scene, sample_surfaces=False)
    if not aim:
        world.items[:, [SAMPLED, LAMP]] = 0
    glowing = (world.items[:, RADIANCE] > 0) & (world.items[:, SAMPLED] == 0)
    bounces = 0 if not scene.reflects else ENDLESS if scene.max_bounces == "all" else scene.max_bounces
    return Paths(world, bounces, bool(len(world.skies) or glowing.any()))
