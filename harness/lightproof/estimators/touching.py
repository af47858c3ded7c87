"""Receivers that lie on something or almost: there rays, which must not meet what they start from, pass by what they should
meet, and what is seen is a limit that not every method takes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

import numpy as np

from lightproof.estimators import elements, world
from lightproof.estimators.blockers import standing
from lightproof.estimators.elements import CENTER, NORMAL
from lightproof.estimators.peaks import distance, from_border
from lightproof.estimators.shapes import COINCIDES, Cap, Flat, Sphere, parts
from lightproof.estimators.terms import without_tubes
from lightproof.estimators.vectors import TINY
from lightproof.estimators.windows import ALONG
from lightproof.geometry import Polygon
from lightproof.scene import PlaneFilm, PointsFilm, Scene

PARALLEL = 1e-12  # 1 - cosine of the angle between directions that are parallel
ADVICE = "move it off along its normal"


class Piece(NamedTuple):
    """A piece of the light or surface of the id `owner`; `sided` where it matters to those in front of it only."""

    owner: str
    shape: Flat | Sphere | Cap
    sided: bool


def outside(shape: Flat | Sphere | Cap, places: np.ndarray) -> np.ndarray:
    """Distance (n,) of places (n, 3) from a shape, of a cap from its whole sphere [m]; below 0 within."""
    if isinstance(shape, Sphere | Cap):
        return np.linalg.norm(places - shape.center, axis=1) - shape.radius
    return distance(shape, places)


def too_near(scene: Scene) -> str | None:
    """What is before a receiver where its rays do not meet it."""
    contact = world.build(scene).contact
    for owner, gap in touched(scene, [*glowing(scene), *blocking(scene)], contact):
        return f"'{owner}' is {gap:.3g} m from a receiver, and to its rays what is within {contact:.3g} m touches; {ADVICE}"
    return None


def no_light_below(scene: Scene) -> str | None:
    """On which light a receiver lies at a slant: it fills half of what is seen, from nearer than any of its points."""
    return lying(scene, glowing(scene))


def no_ball_below(scene: Scene) -> str | None:
    """The same of lights that are not flat."""
    return lying(scene, [piece for piece in glowing(scene) if not isinstance(piece.shape, Flat)])


def nothing_below(scene: Scene) -> str | None:
    """On what a receiver lies at a slant."""
    return lying(scene, [*glowing(scene), *blocking(scene)])


def no_edge_below(scene: Scene) -> str | None:
    """On which light, or on the edge of what, a receiver lies at a slant, where not all is polygons."""
    if all(isinstance(getattr(thing, "shape", None), Polygon) for thing in (*scene.lights, *scene.surfaces)):
        return None
    seen = without_tubes(scene)
    return lying(seen, glowing(seen)) or lying(seen, blocking(seen), "an edge of ", from_border)


def nothing_touched(scene: Scene) -> str | None:
    """On what a receiver lies, at a slant or not."""
    seen, places = without_tubes(scene), np.array(scene.film.positions)
    for owner, shape, _ in [*glowing(seen), *blocking(seen)]:
        if (np.abs(outside(shape, places)) <= slack(shape, places)).any():
            return f"a receiver lies on '{owner}', from where a solid angle has no one value; {ADVICE}"
    return None


def lying(scene: Scene, pieces: Iterable[Piece], part: str = "", away: Callable = outside) -> str | None:
    """On which piece, or which `part` of it, `away` from which distances are measured, a receiver lies at a slant."""
    if not isinstance(scene.film, PointsFilm):
        return None
    for owner, _ in touched(scene, pieces, 0.0, away):
        return f"a receiver lies on {part}'{owner}' at a slant, where it does not take the limit; {ADVICE}"
    return None


def glowing(scene: Scene) -> list[Piece]:
    """What shines outwards."""
    things = [item for item in standing(scene) if item.radiance and getattr(item, "side", "outside") == "outside"]
    return [Piece(item.id, shape, True) for item in things for shape in parts(item.shape)]


def blocking(scene: Scene) -> list[Piece]:
    """What is flat."""
    return [Piece(item.id, shape, False) for item in standing(scene) for shape in parts(item.shape) if isinstance(shape, Flat)]


def touched(scene: Scene, pieces: Iterable[Piece], contact: float, away: Callable = outside) -> Iterator[tuple[str, float]]:
    """Pieces that a receiver touches, no farther than `contact` [m], or than rounding goes, and how far they are [m]; but for
    those on which it lies flush, which are not seen and hide nothing, and those that meet a plane film along lines only."""
    if scene.film.quantity != "irradiance":
        return
    rows, plane = elements.receivers(scene.film), isinstance(scene.film, PlaneFilm)
    for owner, shape, sided in pieces:
        across = facing(shape, rows)
        parallel, along = np.abs(across) >= 1 - PARALLEL, (across if sided else np.abs(across)) <= ALONG
        if plane and not parallel.any():
            continue
        gaps, least = np.abs(away(shape, rows[:, CENTER])), slack(shape, rows[:, CENTER])
        flush = (parallel | along & isinstance(shape, Flat)) & (gaps <= least) | parallel & ~before(shape, rows)
        near = gaps[(gaps <= np.maximum(contact, least)) & ~flush]
        if len(near):
            yield owner, float(near.min())


def facing(shape: Flat | Sphere | Cap, rows: np.ndarray) -> np.ndarray:
    """Cosines (n,) between the normals of receivers (n, 15) and that of the shape there."""
    if isinstance(shape, Flat):
        return rows[:, NORMAL] @ np.array(shape.normal)
    ways = rows[:, CENTER] - shape.center
    return (rows[:, NORMAL] * ways).sum(axis=1) / np.maximum(np.linalg.norm(ways, axis=1), TINY)


def slack(shape: Flat | Sphere | Cap, places: np.ndarray) -> np.ndarray:
    """How far (n,) places (n, 3) that lie on a shape may be from it by rounding [m]."""
    size = np.linalg.norm(shape.u) + np.linalg.norm(shape.v) if isinstance(shape, Flat) else shape.radius
    return COINCIDES * (np.linalg.norm(places, axis=1) + size)


def before(shape: Flat | Sphere | Cap, rows: np.ndarray) -> np.ndarray:
    """Whether the middle of a shape is in front of receivers (n, 15)."""
    return ((np.array(shape.center) - rows[:, CENTER]) * rows[:, NORMAL]).sum(axis=1) > 0
