"""Closed forms at points, Gauss quadrature over elements: no noise. Lambert's formula for polygons clipped at the horizon
and cut by polygons in between (Arvo 1994, 1995); disks, spheres and skies; hard shadows; anything else by a look along all
meridians; spheres and rooms full of reflected light."""

from __future__ import annotations

import numpy as np

from lightproof.estimators import (
    cells,
    hard_lights,
    interiors,
    outlook,
    panorama,
    pictures,
    polygon_lights,
    reflections,
    round_lights,
    solid_angles,
)
from lightproof.estimators.compiled import strict_kernel
from lightproof.estimators.estimator import Estimator, spread
from lightproof.estimators.limits import no_reflections
from lightproof.estimators.sources import desk
from lightproof.estimators.terms import Term
from lightproof.method import Rendering
from lightproof.scene import CameraFilm, PointsFilm, Scene

KINDS = (hard_lights, interiors, panorama, pictures, polygon_lights, round_lights)  # whose sources the kernels take


@strict_kernel
def film(source, curves, elements, first, grid, samples, most, out):
    """Mean over each of `elements`, the first of which has the number `first` in a film of `grid` (rows, columns), and the nodes
    that it took: the columns of `out` (n, 2)."""
    room, mine = desk(source), np.empty((len(curves) + 1, 10))
    for e in range(len(elements)):
        count = cells.own(curves, (first + e) // grid[1], (first + e) % grid[1], grid, mine)
        out[e, 0], out[e, 1] = cells.mean(source, room, elements[e], mine[:count], samples, most)


class Analytic(Estimator):
    """Direct light, also as solid angle or reflected once, and closed shapes full of reflected light; `samples` are the nodes of
    an element, more where it is cut into many pieces, and points need none."""

    deterministic = True
    lengths = (1e-60, 1e60)

    def unsupported(self, scene: Scene) -> str | None:
        if interiors.is_inside(scene):
            return super().unsupported(scene) or interiors.unsupported(scene)
        once = reflections.once(scene)
        return super().unsupported(scene) or no_reflections(once) or outlook.unsupported(once)

    def build(self, scene: Scene) -> None:
        self.film, camera, inside = scene.film, isinstance(scene.film, CameraFilm), interiors.is_inside(scene)
        self.even = interiors.even(scene) if inside else solid_angles.film(scene)
        self.receivers = pictures.rows(scene.film) if camera else outlook.receivers(scene)
        self.terms = []
        if self.even is not None and not np.isnan(self.even).any():
            return
        if inside:
            self.terms = [interiors.term(scene)]
        else:
            once = reflections.once(scene)
            self.terms = pictures.terms(once) if camera else outlook.all_terms(once)

    def warm_up(self) -> None:
        self.render(1, seed=0)

    def render(self, samples: int, seed: int) -> Rendering:
        if not self.terms:
            return Rendering(np.zeros(self.size) if self.even is None else self.even, 1)
        extended = not isinstance(self.film, PointsFilm)
        films = np.array([self.received(term, samples if extended else 1) for term in self.terms])
        total = films[..., 0].sum(axis=0)
        known = total if self.even is None else np.where(np.isnan(self.even), total, self.even)
        return Rendering(known, max(1, round(films[..., 1].mean())))

    def received(self, term: Term, samples: int) -> np.ndarray:
        """Film and nodes (n, 2) of one term."""

        def add(first: int, last: int, span: tuple[int, int], out: np.ndarray) -> None:
            film(term.source, term.curves, self.receivers[first:last], first, self.film.grid, samples, term.most, out)

        return spread(add, self.size, 1, 2, self.threads)
