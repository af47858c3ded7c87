"""Disks, spheres and skies: what has a closed form as a whole, above or cut by the horizon, and a disk before a parallel disk."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from lightproof.estimators import closed_forms
from lightproof.estimators.arcs import disk, disk_behind_disk
from lightproof.estimators.compiled import strict
from lightproof.estimators.sources import desk, irradiance
from lightproof.estimators.tracing import vector
from lightproof.estimators.vectors import dot, norm, sub, unit
from lightproof.estimators.world import CENTER, DISK, KIND, NORMAL, OVERCAST, RADIANCE, RADIUS, SPHERE, UNIFORM, UPPER, U


class Rounds(NamedTuple):
    """The `items` of a `World`, of which disks and spheres are lights here, and rows of `skies` (see `sky_rows`); `shade` (m,) is
    the index of the disk in front of a disk, or -1."""

    items: np.ndarray
    skies: np.ndarray
    shade: np.ndarray

    ROUND = True


@overload(desk)
def _desk(source):
    return (lambda source: 0) if getattr(source, "instance_class", None) is Rounds else None


@overload(irradiance)
def _irradiance(source, desk, x, n):
    return from_rounds if getattr(source, "instance_class", None) is Rounds else None


def from_rounds(source, desk, x, n):
    n = unit(n)
    total = 0.0
    for k in range(len(source.skies)):
        total += from_sky(source.skies[k], n)
    for k in range(len(source.items)):
        if source.items[k, RADIANCE] > 0 and source.items[k, KIND] >= DISK:
            total += source.items[k, RADIANCE] * from_light(source.items, k, x, n, source.shade)
    return total


@strict
def from_light(items, k, x, n, shade):
    """Irradiance at x from item k, per radiance."""
    item = items[k]
    center = sub(vector(item, CENTER), x)
    if item[KIND] == SPHERE:
        return closed_forms.sphere(norm(center), dot(center, n), item[RADIUS])
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
        return sky[1] * closed_forms.upper_sky(dot(n, vector(sky, 2)))
    if sky[0] == OVERCAST:
        return sky[1] * closed_forms.overcast_sky(dot(n, vector(sky, 2)))
    return sky[1] * closed_forms.sphere(1.0, dot(n, vector(sky, 2)), sky[5])
