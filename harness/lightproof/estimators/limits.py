"""What a method cannot do: one question a function, asked of a scene; the answer is the reason, or None."""

from __future__ import annotations

import numpy as np

from lightproof import geometry
from lightproof import scene as scenes
from lightproof.scene import CameraFilm, Scene

LENGTHS = ("vertices", "center", "base", "radius", "height", "position", "positions", "origin", "u", "v", "target", "width")


def extreme(scene: Scene, least: float, most: float) -> str | None:
    """Whether the largest length of a scene [m] is out of a range, in which the fourth powers of lengths neither over- nor
    underflow; nothing has a length where all is in the origin."""
    shapes = [item.shape for item in (*scene.lights, *scene.surfaces) if hasattr(item, "shape")]
    lengths = [getattr(thing, name) for thing in (*shapes, *scene.lights, scene.film) for name in LENGTHS if hasattr(thing, name)]
    largest = max(float(np.abs(length).max()) for length in lengths)
    fits = largest == 0 or least <= largest <= most
    return None if fits else f"the scene's largest length, {largest:.3g} m, is out of its range of {least:g} to {most:g} m"


def no_cylinders(scene: Scene) -> str | None:
    things = [item for item in (*scene.lights, *scene.surfaces) if isinstance(getattr(item, "shape", None), geometry.Cylinder)]
    return f"our estimators have no cylinders ('{things[0].id}' is one)" if things else None


def no_caps(scene: Scene) -> str | None:
    things = [item for item in (*scene.lights, *scene.surfaces) if isinstance(getattr(item, "shape", None), geometry.Cap)]
    return f"it has no spherical caps ('{things[0].id}' is one); path can" if things else None


def no_solid_angle(scene: Scene) -> str | None:
    return "it estimates irradiance and radiance, not solid angles" if scene.film.quantity == "solid_angle" else None


def no_reflections(scene: Scene) -> str | None:
    """Light may be reflected once, by what a camera sees."""
    most = 1 if isinstance(scene.film, CameraFilm) else 0
    if not scene.reflects or (scene.max_bounces != "all" and scene.max_bounces <= most):
        return None
    return "it computes direct light only, and light reaches this film after reflections; path can"


def no_skies(scene: Scene) -> str | None:
    skies = [light for light in scene.lights if isinstance(light, scenes.Environment | scenes.SunDisc | scenes.OvercastSky)]
    return f"it draws points on a light's area, and the environment '{skies[0].id}' has none; mc-cosine can" if skies else None


def no_bulbs(scene: Scene) -> str | None:
    bulbs = [light for light in scene.lights if isinstance(light, scenes.PointLight | scenes.DirectionalLight)]
    return f"'{bulbs[0].id}' fills no solid angle, so that no direction meets it; mc-area and path can" if bulbs else None


def no_glowing_inside(scene: Scene) -> str | None:
    inner = [surface for surface in scene.surfaces if surface.side == "inside"]
    return f"it has no surfaces seen from inside ('{inner[0].id}' is one); path can" if inner else None
