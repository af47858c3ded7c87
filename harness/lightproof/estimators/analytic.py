"""Closed forms at points, Gauss quadrature over elements: no noise. Lambert's formula for polygons clipped at the horizon
and cut by polygons in between (Arvo 1994, 1995); disks, spheres and skies; spheres full of reflected light."""

from __future__ import annotations

import math

import numpy as np

from lightproof.estimators import closed_forms, enclosure, polygons, quadrature
from lightproof.estimators.analytic_limits import direct_unsupported, shades
from lightproof.estimators.arcs import disk, disk_behind_disk
from lightproof.estimators.compiled import strict, strict_kernel
from lightproof.estimators.estimator import Estimator, spread
from lightproof.estimators.lighting import from_bulbs
from lightproof.estimators.limits import no_caps, no_cylinders, no_reflections, no_solid_angle
from lightproof.estimators.polygons import polygon
from lightproof.estimators.tracing import receive, vector
from lightproof.estimators.vectors import dot, norm, sub
from lightproof.estimators.world import (
    CENTER,
    DISK,
    KIND,
    NORMAL,
    OVERCAST,
    RADIANCE,
    RADIUS,
    SPHERE,
    UNIFORM,
    UPPER,
    U,
    build,
)
from lightproof.method import Rendering
from lightproof.scene import Scene


@strict
def from_light(items, k, x, n, shade, contact, pile):
    """Irradiance at x from item k, per radiance."""
    item = items[k]
    center = sub(vector(item, CENTER), x)
    if item[KIND] == SPHERE:
        return closed_forms.sphere(norm(center), dot(center, n), item[RADIUS])
    if item[KIND] != DISK:
        return polygon(items, k, x, n, contact, pile)
    normal, radius = vector(item, NORMAL), norm(vector(item, U))
    blocker = items[shade[k]]
    if shade[k] < 0 or dot(sub(vector(blocker, CENTER), x), n) <= 0:
        return disk(center, normal, radius, n)
    return disk_behind_disk(center, normal, radius, sub(vector(blocker, CENTER), x), norm(vector(blocker, U)), n)


@strict
def from_sky(sky, n):
    """Irradiance on a plane of normal n from a sky [W/m2]."""
    if sky[0] == UNIFORM:
        return math.pi * sky[1]
    if sky[0] == UPPER:
        return sky[1] * closed_forms.upper_sky(n[2])
    if sky[0] == OVERCAST:
        return sky[1] * closed_forms.overcast_sky(n[2])
    return sky[1] * closed_forms.sun(-dot(n, vector(sky, 2)), sky[5])


@strict
def irradiance(items, skies, bulbs, x, n, shade, contact, pile):
    """From everything that shines, directly [W/m2]."""
    total = from_bulbs(items, bulbs, x, n, contact)
    for k in range(len(skies)):
        total += from_sky(skies[k], n)
    for k in range(len(items)):
        if items[k, RADIANCE] > 0:
            total += items[k, RADIANCE] * from_light(items, k, x, n, shade, contact, pile)
    return total


@strict_kernel
def estimate(items, skies, bulbs, film, elements, contact, shade, nodes, out):
    """Film value of each of `elements`: the weighted sum over `nodes` (m, 3): p, q, weight; `shade` (items) is the index of
    the disk in front of a disk, or -1; `out` (n, 1)."""
    pile = np.empty((polygons.PILE, polygons.VERTICES, 3))
    for e in range(len(elements)):
        total = 0.0
        for i in range(len(nodes)):
            value, factor, x, n = receive(items, skies, film, elements[e], nodes[i, 0], nodes[i, 1], contact)
            if factor > 0:
                value += factor * irradiance(items, skies, bulbs, x, n, shade, contact, pile)
            total += nodes[i, 2] * value
        out[e, 0] = total


class Analytic(Estimator):
    """Direct light of the shapes that have a closed form, and spheres full of reflected light; `samples` are the nodes of
    an element, and points need none."""

    deterministic = True
    limits = (no_cylinders, no_caps, no_solid_angle)

    def unsupported(self, scene: Scene) -> str | None:
        if any(surface.side == "inside" for surface in scene.surfaces):
            return super().unsupported(scene) or enclosure.unsupported(scene)
        return super().unsupported(scene) or no_reflections(scene) or direct_unsupported(scene)

    def build(self, scene: Scene) -> None:
        self.scene = scene
        self.world = build(scene)
        self.enclosed = any(surface.side == "inside" for surface in scene.surfaces)
        self.shade = shades(scene, self.world.items)
        self.extended = bool(np.any(self.world.elements[:, 3:9]))  # points have no cells

    def warm_up(self) -> None:
        self.render(1, seed=0)

    def render(self, samples: int, seed: int) -> Rendering:
        nodes = quadrature.square(samples if self.extended else 1)
        if self.enclosed:
            return Rendering(enclosure.film(self.scene, self.world.elements, nodes), len(nodes))
        items, skies, bulbs, film, rows, contact = self.world.arrays

        def add(first: int, last: int, span: tuple[int, int], out: np.ndarray) -> None:
            estimate(items, skies, bulbs, film, rows[first:last], contact, self.shade, nodes, out)

        return Rendering(spread(add, self.size, 1, 1, self.threads)[:, 0], len(nodes))
