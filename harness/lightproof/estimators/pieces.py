"""Direct light piece by piece: one source of the compiled kernel each, with what can stand before it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lightproof.estimators import lamps, skies, world
from lightproof.estimators.aims import Aim
from lightproof.estimators.blockers import Casters, between, plane_of, standing
from lightproof.estimators.crowd import Crowd
from lightproof.estimators.estimator import spread, tasks
from lightproof.estimators.kernel import estimate
from lightproof.estimators.lamps import Beam, Glow, Lamp, Point
from lightproof.estimators.meeting import Cosine, Uniform
from lightproof.estimators.moments import moments
from lightproof.estimators.parallel import Between, Level, levelled
from lightproof.estimators.points import BLOCK, Grid, Random
from lightproof.estimators.shapes import Flat, Sphere
from lightproof.estimators.views import View
from lightproof.scene import Scene

WORTHWHILE = 2**17  # samples: a task takes longer than to hand it to a thread
FEW = 3  # blockers that are worth a kernel of their own
REACH = 1e4  # sizes of the scene: the length of a shadow ray along a beam or to the sky

Source = Lamp | Point | Beam | Uniform | Cosine | Aim


@dataclass(frozen=True)
class Piece:
    """One piece of a light with what can shadow it; `source` is the lamp as the kernel takes it."""

    lamp: Source
    source: Source | Level
    blockers: tuple[Flat | Sphere | Between, ...] | Crowd

    @property
    def power(self) -> float:
        """What its share of samples goes by."""
        return getattr(self.lamp, "power", self.lamp.strength)

    def received(self, view: View, points: Random | Grid, model: np.floating, threads: int) -> tuple[np.ndarray, np.ndarray]:
        """Film (n,) of this piece alone, and its variance (n,) if points do not depend on one another."""

        def add(first: int, last: int, blocks: tuple[int, int], out: np.ndarray) -> None:
            slopes = None if view.slopes is None else view.slopes[first:last]
            estimate(self.source, self.blockers, view.receivers[first:last], slopes, first, points, blocks, model, out)

        size = len(view.receivers)
        sums = spread(add, size, -(-points.samples // BLOCK), 3, threads, tasks(size * points.samples, WORTHWHILE))
        return moments(sums, points.samples, view.factor)


def aimed(scene: Scene, view: View, aim: Callable[[Glow], Source] = lamps.lamp) -> list[Piece]:
    """Every piece of every light, to be aimed at as the source that `aim` makes of it."""
    owned = [(glow.owner, aim(glow)) for glow in lamps.glowing(scene)]
    casters = Casters.of(standing(scene))
    return [shadowed(casters, view, owner, source) for owner, source in (*owned, *lamps.bulbs(scene, reach(scene)))]


def met(scene: Scene, view: View, kind: type[Uniform | Cosine]) -> list[Piece]:
    """Every piece of every light with an area, and the dome of all skies, to be met by directions."""
    owned = [(glow.owner, kind(glow.shape, glow.radiance)) for glow in lamps.glowing(scene)]
    dome = skies.dome(scene, reach(scene))
    if dome:
        owned.append(("", kind(dome, 1.0)))
    casters = Casters.of(standing(scene))
    return [shadowed(casters, view, owner, source) for owner, source in owned]


def reach(scene: Scene) -> float:
    """A length that leads out of the scene [m]."""
    return REACH * world.build(scene).contact / world.CONTACT


def shadowed(casters: Casters, view: View, owner: str, source: Source) -> Piece:
    """A source of the light `owner` with what of `casters` can stand before it."""
    shape = getattr(source, "shape", getattr(source, "light", None))
    blockers = between(casters, owner, plane_of(shape), view.plane)
    if len(blockers.pieces) > FEW:
        return Piece(source, source, Crowd.of(blockers.rows))
    return Piece(source, *levelled(source, blockers.pieces, view.plane))
