"""Direct light as fast as Mitsuba can be made to give it, in two ways.

`Loop` has no camera, no film and no integrator, only Mitsuba's own emitter sampling: points of the film's plane ask the
scene for a light sample, with the shadow ray, `scene.sample_emitter_direction`. All samples of a lane run in one compiled
loop that keeps its sum in a register, so that nothing is written to memory but a sum a lane. `Bundle` is Mitsuba's direct
integrator with many light samples for each of its camera's: they cost less each, and are worth less, because they share a
point of the film.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from lightproof.method import Rendering
from lightproof.renderers.mitsuba import Mitsuba
from lightproof.scene import PlaneFilm, Scene

LANES = 2**18  # that work side by side, about: enough to fill every core's vector registers many times
MOST = 64  # lanes of one element
BUNDLE = 16  # light samples of a camera sample


class Loop(Mitsuba):
    """Irradiance of a plane film under lights that Mitsuba samples, without reflections."""

    def settings(self) -> Mapping[str, Any]:
        return {"variant": self.variant, "loop": "scene.sample_emitter_direction", "random": "PCG32"}

    def unsupported(self, scene: Scene) -> str | None:
        if not isinstance(scene.film, PlaneFilm) or scene.reflects:
            return "the loop fills plane films with direct light"
        return super().unsupported(scene)

    def prepare(self, scene: Scene) -> Mapping[str, float]:
        self.film = scene.film
        return super().prepare(scene)

    def _view(self, view: Any) -> dict[str, Any]:
        """No camera and no receiver."""
        return {"type": "scene"}

    def render(self, samples: int, seed: int) -> Rendering:
        elements = int(np.prod(self.film.resolution))
        lanes = min(MOST, max(1, LANES // elements), samples)
        each = -(-samples // lanes)
        self._watch(samples)
        total = self._summed(elements, lanes, each, seed)
        film = np.array(self.dr.block_sum(total, lanes), float) / (lanes * each)
        return Rendering(film, lanes * each, seconds={"compile": self._compiling()})

    def _summed(self, elements: int, lanes: int, each: int, seed: int) -> Any:
        """Sums of `each` samples, one a lane."""
        mi, size = self.mi, elements * lanes
        element = self.dr.arange(mi.UInt32, size) // lanes
        columns = self.film.resolution[0]
        column, row = mi.Float(element % columns), mi.Float(element // columns)
        state = (mi.UInt32(0), mi.Float(0), mi.PCG32(size=size, initstate=seed))
        return self.dr.while_loop(state, lambda done, total, random: done < each,
                                  lambda done, total, random: (done + 1, total + self._sample(column, row, random), random))[1]

    def _sample(self, column: Any, row: Any, random: Any) -> Any:
        """One sample of irradiance at a random point of each lane's element."""
        mi, (columns, rows) = self.mi, self.film.resolution
        origin, u, v = (mi.ScalarVector3f(list(vector)) for vector in (self.film.origin, self.film.u, self.film.v))
        along, up = (column + random.next_float32()) / columns, (row + random.next_float32()) / rows
        place = self.dr.zeros(mi.SurfaceInteraction3f)
        place.p, place.n = origin + along * u + up * v, mi.Normal3f(self.film.normal.tolist())
        draw = mi.Point2f(random.next_float32(), random.next_float32())
        found, weight = self.scenes[0].sample_emitter_direction(place, draw, True)
        return weight[0] * self.dr.maximum(self.dr.dot(found.d, place.n), 0)


class Bundle(Mitsuba):
    """Light of one reflection at most; each light sample counts as one."""

    def unsupported(self, scene: Scene) -> str | None:
        return "bundles are of direct light" if scene.reflects else super().unsupported(scene)

    def _view(self, view: Any) -> dict[str, Any]:
        self.integrator = {"type": "direct", "emitter_samples": BUNDLE, "bsdf_samples": 0}
        return super()._view(view)

    def render(self, samples: int, seed: int) -> Rendering:
        rendering = super().render(-(-samples // BUNDLE), seed)
        return replace(rendering, samples=BUNDLE * rendering.samples)
