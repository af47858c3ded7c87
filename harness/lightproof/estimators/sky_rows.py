"""Skies as rows of numbers, for the closed forms: kind, radiance, unit vector up or to the sun, sine of a sun's half-angle."""

from __future__ import annotations

import numpy as np

from lightproof import geometry
from lightproof.estimators.world import OVERCAST, SUN, UNIFORM, UPPER
from lightproof.scene import Environment, OvercastSky, Scene, SunDisc

SKIES = Environment | SunDisc | OvercastSky
UP = (0.0, 0.0, 1.0)


def sky_rows(scene: Scene, angle: bool = False) -> np.ndarray:
    """All skies of a scene (k, 6); with a radiance of 1 where their solid `angle` is asked for."""
    return np.array([row(light, angle) for light in scene.lights if isinstance(light, SKIES)], float).reshape(-1, 6)


def row(light: SKIES, angle: bool) -> list[float]:
    match light:
        case SunDisc() if np.sin(np.radians(light.half_angle)) == 1:
            return [UPPER, 1.0 if angle else light.radiance, *-geometry.unit(light.direction), 0.0]
        case SunDisc():
            return [SUN, 1.0 if angle else light.radiance, *-geometry.unit(light.direction), np.sin(np.radians(light.half_angle))]
        case OvercastSky():
            return [UPPER, 1.0, *UP, 0.0] if angle else [OVERCAST, light.zenith_radiance, *UP, 0.0]
    return [UNIFORM if light.extent == "sphere" else UPPER, 1.0 if angle else light.radiance, *UP, 0.0]
