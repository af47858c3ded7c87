"""Receivers that lie on something or almost: there rays, which must not meet what they start from, pass by what they should
meet, and what is seen is a limit that not every method takes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

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
from lightproof.scene import PlaneFilm, Scene

PARALLEL = 1e-12  # 1 - cosine of the angle between directions that are parallel

Piece = tuple[str, Flat | Sphere | Cap]  # of the light or surface of this id


def outside(shape: Flat | Sphere | Cap, places: np.ndarray) -> np.ndarray:
    """Distance (n,) of places (n, 3) from a shape, of a cap from its whole sphere [m]; below 0 within."""
    if isinstance(shape, Sphere | Cap):
        return np.linalg.norm(places - shape.center, axis=1) - shape.radius
    return distance(shape, places)


def too_near(scene: Scene) -> str | None:
    """What is before a receiver where its rays do not meet it."""
    contact = world.build(scene).contact
    for owner, gap in touched(scene, [*glowing(scene), *blocking(scene)], world.CONTACT):
        return f"'{owner}' is {gap:.3g} m from a receiver, and to its rays what is within {contact:.3g} m touches; analytic can"
    return None


def on_light(scene: Scene) -> str | None:
    """On which light a receiver lies at a slant: it fills half of what is seen, from nearer than any of its points."""
    return lying(scene, glowing(scene))


def on_ball(scene: Scene) -> str | None:
    """The same of lights that are not flat."""
    return lying(scene, [(owner, shape) for owner, shape in glowing(scene) if not isinstance(shape, Flat)])


def on_anything(scene: Scene) -> str | None:
    """What a receiver lies on at a slant."""
    return lying(scene, [*glowing(scene), *blocking(scene)])


def among_shapes(scene: Scene) -> str | None:
    """The light, or the edge of anything, on which a receiver lies at a slant, where not all is polygons."""
    if all(isinstance(getattr(thing, "shape", None), Polygon) for thing in (*scene.lights, *scene.surfaces)):
        return None
    seen = without_tubes(scene)
    return lying(seen, glowing(seen)) or lying(seen, blocking(seen), from_border)


def lying(scene: Scene, pieces: Iterable[Piece], away: Callable = outside) -> str | None:
    for owner, _ in touched(scene, pieces, COINCIDES, away):
        where = "an edge of " if away is from_border else ""
        return f"a receiver lies on {where}'{owner}' at a slant, where it does not take the limit; move it off along its normal"
    return None


def glowing(scene: Scene) -> list[Piece]:
    return pieces(scene, lambda item, _: item.radiance and getattr(item, "side", "outside") == "outside")


def blocking(scene: Scene) -> list[Piece]:
    """What is flat."""
    return pieces(scene, lambda _, piece: isinstance(piece, Flat))


def pieces(scene: Scene, chosen: Callable) -> list[Piece]:
    return [(item.id, piece) for item in standing(scene) for piece in parts(item.shape) if chosen(item, piece)]


def touched(scene: Scene, pieces: Iterable[Piece], share: float, away: Callable = outside) -> Iterator[tuple[str, float]]:
    """Pieces that a receiver touches, no farther than this share of the scene's size, and how far they are [m]; but for those on
    which it lies flush, which are not seen and hide nothing, and those that run through an element, along a line of it."""
    if scene.film.quantity != "irradiance":
        return
    rows, size = elements.receivers(scene.film), world.build(scene).contact / world.CONTACT
    for owner, shape in pieces:
        gaps, across = np.abs(away(shape, rows[:, CENTER])), across_of(shape, rows)
        parallel = across >= 1 - PARALLEL
        flush = parallel | (across <= ALONG) & isinstance(shape, Flat)
        met = parallel if isinstance(scene.film, PlaneFilm) else True
        near = gaps[(gaps <= share * size) & met & ~(flush & (gaps <= COINCIDES * size))]
        if len(near):
            yield owner, float(near.min())


def across_of(shape: Flat | Sphere | Cap, rows: np.ndarray) -> np.ndarray:
    """|cos| of the angles (n,) between the normals of receivers (n, 15) and that of the shape there."""
    if isinstance(shape, Flat):
        return np.abs(rows[:, NORMAL] @ np.array(shape.normal))
    ways = rows[:, CENTER] - shape.center
    return np.abs((rows[:, NORMAL] * ways).sum(axis=1)) / np.maximum(np.linalg.norm(ways, axis=1), TINY)
