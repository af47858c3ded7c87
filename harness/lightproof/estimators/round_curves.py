"""Where on a film the visible shape of a light changes behind curved shapes, or that of a curved light: lines and conics.

A corner of a polygon light comes out from behind a sphere or a disk: the edge of its shadow in the light of a point. An edge of
it touches a sphere's outline: a plane through the edge touches the sphere. A sphere or a parallel disk begins to cover a sphere
or a disk, or covers it wholly: the edge of its shadow in the light of a point on their axis. Other events get no curve.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lightproof import geometry
from lightproof.estimators import hard_curves
from lightproof.estimators.hard_curves import Rays
from lightproof.estimators.sheet import Sheet
from lightproof.estimators.soft_curves import edges
from lightproof.geometry import Cylinder, Disk, Polygon, Shape, Sphere
from lightproof.scene import AreaLight, Scene, Surface

PARALLEL = 1e-12  # 1 - |cosine| of two disks that count as parallel


def curves(sheet: Sheet, scene: Scene) -> list[np.ndarray]:
    """Rows of curves of all that shines and all that stands before it."""
    shapes = [thing for thing in (*scene.lights, *scene.surfaces) if isinstance(thing, AreaLight | Surface)]
    lamps = [thing for thing in shapes if thing.radiance]
    return [row for lamp in lamps for row in alone(sheet, lamp.shape)] + [
        row for lamp in lamps for other in shapes if other is not lamp for row in behind(sheet, lamp.shape, other.shape)
    ]


def alone(sheet: Sheet, lamp: Shape) -> Iterator[np.ndarray]:
    """Where a light's own plane meets the film."""
    if isinstance(lamp, Polygon | Disk):
        point = lamp.center if isinstance(lamp, Disk) else lamp.vertices[0]
        normal = geometry.unit(lamp.normal)
        yield sheet.lines(normal[None], np.array(point)[None])


def behind(sheet: Sheet, lamp: Shape, blocker: Shape) -> Iterator[np.ndarray]:
    match lamp, blocker:
        case Polygon(), Sphere() | Disk() | Cylinder():
            for corner in lamp.vertices:
                yield from hard_curves.curves(sheet, Rays(np.array(corner), False), [blocker])
            if isinstance(blocker, Sphere):
                for start, end in edges(np.array(lamp.vertices)):
                    yield touching(sheet, start, end - start, blocker)
        case Disk() | Sphere(), Disk() | Sphere():
            for apex in apexes(lamp, blocker):
                yield from hard_curves.curves(sheet, Rays(apex, False), [blocker])
        case Sphere(), Polygon():
            for start, end in edges(np.array(blocker.vertices)):
                yield touching(sheet, start, end - start, lamp)
            for corner in blocker.vertices:
                yield from hard_curves.curves(sheet, Rays(np.array(corner), False), [lamp])


def touching(sheet: Sheet, start: np.ndarray, along: np.ndarray, ball: Sphere) -> np.ndarray:
    """The lines in which the two planes through a line that touch a sphere meet the film."""
    e = geometry.unit(along)
    to = np.array(ball.center) - start
    foot = to - (to @ e) * e
    d = np.linalg.norm(foot)
    if d <= ball.radius:
        return np.zeros((0, 10))
    sine = ball.radius / d
    a, b = foot / d, np.cross(e, foot / d)
    normals = [sine * a + sign * np.sqrt((1 - sine) * (1 + sine)) * b for sign in (-1, 1)]
    return sheet.lines(np.array(normals), np.array([start, start]))


def apexes(lamp: Disk | Sphere, blocker: Disk | Sphere) -> list[np.ndarray]:
    """The points on the line through two centres from which one round shape covers the other exactly; none for disks that are not
    parallel."""
    if type(lamp) is not type(blocker):
        return []
    if isinstance(lamp, Disk) and 1 - abs(geometry.unit(lamp.normal) @ geometry.unit(blocker.normal)) > PARALLEL:
        return []
    a, b = np.array(lamp.center), np.array(blocker.center)
    shares = [lamp.radius / (lamp.radius + sign * blocker.radius) for sign in (-1, 1) if lamp.radius + sign * blocker.radius]
    return [a + share * (b - a) for share in shares]
