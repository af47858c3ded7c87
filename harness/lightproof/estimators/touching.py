"""Receivers so near to a light that rays, which must not meet what they start from, would take the light for that."""

from __future__ import annotations

import numpy as np

from lightproof.estimators import elements, lamps, world
from lightproof.estimators.elements import CENTER
from lightproof.estimators.peaks import distance
from lightproof.estimators.shapes import COINCIDES, Cap, Flat, Sphere
from lightproof.scene import CameraFilm, Scene


def touching(scene: Scene) -> str | None:
    """Which light is before a receiver, and too near; what lies on it, but for rounding, sees nothing of it."""
    if isinstance(scene.film, CameraFilm):
        return None
    places, contact = elements.receivers(scene.film)[:, CENTER], world.build(scene).contact
    size = contact / world.CONTACT
    for glow in lamps.glowing(scene):
        away = outside(glow.shape, places)
        near = away[(away > COINCIDES * size) & (away <= contact)]
        if len(near):
            apart = f"'{glow.owner}' is {near.min():.3g} m from a receiver"
            return f"{apart}, and to its rays what is within {contact:.3g} m touches; path can"
    return None


def outside(shape: Flat | Sphere | Cap, places: np.ndarray) -> np.ndarray:
    """Distance (n,) of places (n, 3) from a light, of a cap from its whole sphere [m]; below 0 within."""
    if isinstance(shape, Sphere | Cap):
        return np.linalg.norm(places - shape.center, axis=1) - shape.radius
    return distance(shape, places)
