"""Closed forms at points, Gauss quadrature over elements: no noise. Lambert's formula for polygons clipped at the horizon
and cut by polygons in between (Arvo 1994, 1995); disks, spheres and skies; hard shadows; spheres full of reflected light."""

from __future__ import annotations

import numpy as np

from lightproof.estimators import cells, enclosure, hard_lights, polygon_lights, quadrature, round_lights, world
from lightproof.estimators.analytic_limits import direct_unsupported
from lightproof.estimators.compiled import strict_kernel
from lightproof.estimators.estimator import Estimator, spread
from lightproof.estimators.limits import no_reflections, no_solid_angle
from lightproof.estimators.sources import desk, irradiance
from lightproof.estimators.terms import Term, receivers, terms
from lightproof.estimators.tracing import receive
from lightproof.method import Rendering
from lightproof.scene import CameraFilm, PointsFilm, Scene

KINDS = (hard_lights, polygon_lights, round_lights)  # whose sources the kernels take: each overloads `desk` and `irradiance`


@strict_kernel
def film(source, curves, elements, first, grid, samples, most, out):
    """Mean over each of `elements`, the first of which has the number `first` in a film of `grid` (rows, columns), and the nodes
    that it took: the columns of `out` (n, 2)."""
    room, mine = desk(source), np.empty((len(curves) + 1, 10))
    for e in range(len(elements)):
        count = cells.own(curves, (first + e) // grid[1], (first + e) % grid[1], grid, mine)
        out[e, 0], out[e, 1] = cells.mean(source, room, elements[e], mine[:count], samples, most)


@strict_kernel
def picture(source, items, skies, film, elements, contact, glow, nodes, out):
    """Mean radiance of a camera's pixels from a source's light reflected once, over `nodes` (m, 3): p, q, weight; and `glow` times
    what they see shine; `out` (n, 1)."""
    room = desk(source)
    for e in range(len(elements)):
        total = 0.0
        for i in range(len(nodes)):
            value, factor, x, n = receive(items, skies, film, elements[e], nodes[i, 0], nodes[i, 1], contact)
            total += nodes[i, 2] * glow * value
            if factor > 0:
                total += nodes[i, 2] * factor * irradiance(source, room, x, n)
        out[e, 0] = total


class Analytic(Estimator):
    """Direct light of the shapes that have a closed form, and spheres full of reflected light; `samples` are the nodes of
    an element, more where it is cut into many pieces, and points need none."""

    deterministic = True
    lengths = (1e-60, 1e60)
    limits = (no_solid_angle,)

    def unsupported(self, scene: Scene) -> str | None:
        if any(surface.side == "inside" for surface in scene.surfaces):
            return super().unsupported(scene) or enclosure.unsupported(scene)
        return super().unsupported(scene) or no_reflections(scene) or direct_unsupported(scene)

    def build(self, scene: Scene) -> None:
        self.scene = scene
        self.enclosed = any(surface.side == "inside" for surface in scene.surfaces)
        self.camera = isinstance(scene.film, CameraFilm)
        self.world = world.build(scene) if self.enclosed or self.camera else None
        self.terms = [] if self.enclosed else terms(scene)
        self.receivers = receivers(scene)

    def warm_up(self) -> None:
        self.render(1, seed=0)

    def render(self, samples: int, seed: int) -> Rendering:
        extended = not isinstance(self.scene.film, PointsFilm)
        nodes = quadrature.square(samples if extended else 1)
        if not (self.terms or self.enclosed or self.camera):
            return Rendering(np.zeros(self.size), 1)
        if self.enclosed:
            return Rendering(enclosure.film(self.scene, self.world.elements, nodes), len(nodes))
        if self.camera:
            return Rendering(sum(self.seen(index, nodes) for index in range(len(self.terms))), len(nodes))
        films = np.array([self.received(term, samples if extended else 1) for term in self.terms])
        return Rendering(films[..., 0].sum(axis=0), max(1, round(films[..., 1].mean())))

    def seen(self, index: int, nodes: np.ndarray) -> np.ndarray:
        """Film (n,) of what a camera sees of one term's light; what shines itself goes with the first."""
        items, skies, _, film, rows, contact = self.world.arrays
        source, glow = self.terms[index].source, float(index == 0)

        def add(first: int, last: int, span: tuple[int, int], out: np.ndarray) -> None:
            picture(source, items, skies, film, rows[first:last], contact, glow, nodes, out)

        return spread(add, self.size, 1, 1, self.threads)[:, 0]

    def received(self, term: Term, samples: int) -> np.ndarray:
        """Film and nodes (n, 2) of one term."""

        def add(first: int, last: int, span: tuple[int, int], out: np.ndarray) -> None:
            film(term.source, term.curves, self.receivers[first:last], first, self.scene.film.grid, samples, term.most, out)

        return spread(add, self.size, 1, 2, self.threads)
