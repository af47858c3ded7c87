"""Monte Carlo over the lights' area: E ~ (1/N) sum L V cos(theta_x) cos(theta_y) / (r^2 p), y uniform over the light.

The kernel is one function, compiled for what the scene has: its kind of light, its blockers (none: no visibility test),
its precision.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import types
from numba.extending import overload

from lightproof.estimators import crowd, elements, path, world
from lightproof.estimators.blockers import all_placed, between, visible
from lightproof.estimators.compiled import fast, fast_kernel
from lightproof.estimators.crowd import shadow_all
from lightproof.estimators.estimator import Estimator, sampled, spread, variance_of_mean
from lightproof.estimators.lamps import Beam, Lamp, Point, arriving, faced, lamps
from lightproof.estimators.limits import no_cylinders, no_glowing_inside, no_reflections, no_skies, no_solid_angle
from lightproof.estimators.rng import TICK, block_keys, draws, stream
from lightproof.estimators.shapes import Flat, Sphere
from lightproof.estimators.vectors import like
from lightproof.method import Rendering
from lightproof.scene import CameraFilm, Scene

BLOCK = 2048  # samples between two draws of the lattice's shift, summed in the kernel's precision; blocks add in float64
ZERO = np.uint32(0)
FEW = 3  # blockers that are worth a kernel of their own
REACH = 100.0  # sizes of the scene: the length of a shadow ray along a beam


@fast
def on_cell(cell, p, q):
    """A point of the element in its own frame."""
    return p * cell[0] + q * cell[1], q * cell[2], like(p, 0)


def sum_block(lamp, blockers, cell, keys, count, pivot):
    """Sum of (f - pivot) and of its square over `count` samples, f per strength of the lamp."""


@overload(sum_block)
def _sum_block(lamp, blockers, cell, keys, count, pivot):
    return sum_staged if isinstance(blockers, types.Array) else sum_fused


def sum_fused(lamp, blockers, cell, keys, count, pivot):
    """Few blockers: all in one loop, which runs in vector registers."""
    zero = like(pivot, 0)
    total, square = zero, zero
    for i in range(count):
        s, t, p, q = draws(i, keys, pivot)
        x = on_cell(cell, p, q)
        f, d = arriving(lamp, x, s, t)
        f = (f if visible(blockers, x, d) else zero) - pivot
        total += f
        square += f * f
    return total, square


def sum_staged(lamp, blockers, cell, keys, count, pivot):
    """Many blockers: the block's samples are laid out first, then shadowed by one blocker after the other."""
    x, d, f = np.full((2, count), pivot), np.full((3, count), pivot), np.full(count, pivot)
    for i in range(count):
        s, t, p, q = draws(i, keys, pivot)
        at = on_cell(cell, p, q)
        f[i], to = arriving(lamp, at, s, t)
        x[0, i], x[1, i] = at[0], at[1]
        d[0, i], d[1, i], d[2, i] = to
    shadow_all(blockers, x, d, f)
    total, square = like(pivot, 0), like(pivot, 0)
    for i in range(count):
        total += f[i] - pivot
        square += (f[i] - pivot) * (f[i] - pivot)
    return total, square


@fast
def sum_blocks(lamp, blockers, cell, key, blocks, samples, pivot):
    """The same over blocks `blocks[0]` to `blocks[1]` of `samples`, in float64; every block has its own random key."""
    total, square = 0.0, 0.0
    for block in range(blocks[0], blocks[1]):
        sums = sum_block(lamp, blockers, cell, block_keys(key, block), min(BLOCK, samples - block * BLOCK), pivot)
        total += sums[0]
        square += sums[1]
    return total, square


@fast_kernel
def estimate(lamp, blockers, elements, first, seed, blocks, samples, model, out):
    """Adds up blocks `blocks[0]` to `blocks[1]` of `samples` for each of `elements` (n, 15), the first of which is the film's
    element `first`. `out` (n, 3): sums over the samples of the pivot, of f - pivot and of its square."""
    for e in range(len(elements)):
        row = elements[e]
        origin = row[0], row[1], row[2]
        frame = (row[3], row[4], row[5]), (row[6], row[7], row[8]), (row[9], row[10], row[11])
        cell = like(model, row[12] * TICK), like(model, row[13] * TICK), like(model, row[14] * TICK)
        seen, between = faced(lamp, origin, frame, model), all_placed(blockers, origin, frame, model)
        zero = like(model, 0)
        pivot = sum_block(seen, between, (zero, zero, zero), (ZERO, ZERO, ZERO, ZERO), 1, zero)[0]
        total, square = sum_blocks(seen, between, cell, stream(seed, first + e, 0), blocks, samples, pivot)
        drawn = np.float64(min(blocks[1] * BLOCK, samples) - blocks[0] * BLOCK)
        out[e, 0], out[e, 1], out[e, 2] = lamp.strength * drawn * pivot, lamp.strength * total, lamp.strength**2 * square


@dataclass(frozen=True)
class Piece:
    """One piece of a light with what can shadow it, and its `share` of the samples; `index` names its random streams."""

    index: int
    lamp: Lamp | Point | Beam
    blockers: tuple[Flat | Sphere, ...] | np.ndarray
    share: float

    def film(self, receivers: np.ndarray, samples: int, seed: int, model: np.floating, threads: int) -> tuple:
        """Film (n,) of this piece alone and its variance (n,), from `samples` per element."""
        own_seed = int(seed) * 2**24 + self.index

        def add(first: int, last: int, blocks: tuple[int, int], out: np.ndarray) -> None:
            estimate(self.lamp, self.blockers, receivers[first:last], first, own_seed, blocks, samples, model, out)

        pivots, totals, squares = spread(add, len(receivers), -(-samples // BLOCK), 3, threads).T
        return (pivots + totals) / samples, variance_of_mean(totals, squares, samples)


def pieces(scene: Scene) -> list[Piece]:
    """Every piece of every light; samples are shared out by strength."""
    owned = lamps(scene, reach=REACH * world.build(scene).contact / world.CONTACT)
    level = elements.flat(scene.film)
    power = np.array([lamp.strength for _, lamp in owned])
    shares = power / power.sum() if power.any() else np.full(len(owned), 1 / len(owned))
    return [
        Piece(index, lamp, packed(between(scene, owner, getattr(lamp, "shape", None), level)), float(share))
        for index, ((owner, lamp), share) in enumerate(zip(owned, shares, strict=True))
    ]


def packed(blockers: list[Flat | Sphere]) -> tuple[Flat | Sphere, ...] | np.ndarray:
    """Few blockers as a tuple, which the kernel is compiled for; many as rows."""
    return tuple(blockers) if len(blockers) <= FEW else crowd.rows(blockers)


class McArea(Estimator):
    """Plane and points films by the kernel above; camera films by paths of one reflection, which trace the first ray."""

    limits = (no_cylinders, no_solid_angle, no_reflections, no_skies, no_glowing_inside)

    def __init__(self, name: str, threads: int):
        super().__init__(name, threads)
        self.model = np.float64(1) if name.endswith("/float64") else np.float32(1)

    def settings(self) -> Mapping[str, Any]:
        return {"sampler": "independent", "density": "uniform over the light; of a sphere, over the cap that faces the receiver"}

    def build(self, scene: Scene) -> None:
        camera = isinstance(scene.film, CameraFilm)
        self.precision = "float64" if camera else str(self.model.dtype)
        self.paths = path.Paths(world.build(scene), min(scene.max_bounces, 1), glow=False) if camera else None
        self.receivers = None if camera else elements.receivers(scene.film)
        self.pieces = [] if camera else pieces(scene)

    def warm_up(self) -> None:
        self.render(1, seed=0)

    def render(self, samples: int, seed: int) -> Rendering:
        if self.paths:
            return Rendering(*sampled(self.paths.add, self.size, samples, seed, self.threads))
        counts = [max(1, round(samples * piece.share)) for piece in self.pieces]
        shared = zip(self.pieces, counts, strict=True)
        drawn = [piece.film(self.receivers, count, seed, self.model, self.threads) for piece, count in shared]
        films, variances = zip(*drawn, strict=True)
        return Rendering(sum(films), sum(counts), None if any(one is None for one in variances) else sum(variances))
