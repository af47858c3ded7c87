"""How Radiance gets the light of a scene: what shadow rays aim at, and how often it looks around from where light arrives.

Radiance aims at every `light` from every point, but finds a `glow` or the sky only by looking around ("ambient bounces",
-ab), which costs one bounce more for the same light.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from lightproof.geometry import Cap, Polygon, Shape, Sphere, unit
from lightproof.renderers import radiance_apertures, transport
from lightproof.scene import (
    AreaLight,
    CameraFilm,
    DirectionalLight,
    Environment,
    OvercastSky,
    PointLight,
    PointsFilm,
    Scene,
    SunDisc,
    Surface,
)

BOUNCES = 1400  # each goes deeper into rtrace's stack, which ends before 2,000
WIDEST = 60  # degrees: half angle of a distant disc


@dataclass(frozen=True)
class Transport:
    """`bounces` is -ab. With `aims`, shadow rays aim at parallelograms, points and beams; with `aperture`, at the one lamp of
    another shape too, through an aperture, which stops rays that look around or aim at another aperture; with `middle` one
    ray at the middle of a ball says all."""

    bounces: int
    aims: bool = True
    aperture: bool = False
    native: bool = False
    middle: bool = False

    def aims_at(self, shape: Shape) -> bool:
        """Whether a lamp of this shape is a light that shadow rays aim at."""
        return self.aims and (is_parallelogram(shape) or (self.native and not isinstance(shape, Cap)))


def transport_of(scene: Scene, native: bool = False) -> Transport:
    """What Radiance has to do for a scene; with `native` shadow rays aim at lamps of every shape as Radiance samples them."""
    shaped = [] if native else [lamp for lamp in lamps(scene) if not is_parallelogram(lamp.shape)]
    camera = isinstance(scene.film, CameraFilm)
    reflections = transport.reflections(scene, BOUNCES)
    direct = max(reflections - camera, 0)
    if not _around(scene) and not shaped:
        return Transport(direct, native=native)
    if _is_lone_ball(scene):
        return Transport(0, native=True, middle=True)
    if not _around(scene) and direct == 0 and len(shaped) == 1:
        return Transport(0, aperture=True)
    aims = scene.max_bounces == "all" or not scene.reflects
    return Transport(reflections + (not camera), aims, native=native)


def unsupported(scene: Scene, planned: Transport) -> str | None:
    """Why Radiance cannot follow the light of a scene as planned, or None."""
    suns = _suns(scene)
    if sum(isinstance(light, Environment | OvercastSky) for light in scene.lights) > 1:
        return "Radiance sees one sky at a time"
    if suns and (len(suns) > 1 or _around(scene) or not all(planned.aims_at(lamp.shape) for lamp in lamps(scene))):
        return "the aperture through which Radiance is shown a distant disc would hide a part of what else shines"
    if any(sun.half_angle > WIDEST for sun in suns):
        return f"the flat aperture through which Radiance is shown a distant disc holds one of at most {WIDEST} degrees"
    if not planned.aims and any(isinstance(light, PointLight | DirectionalLight) for light in scene.lights):
        return ("Radiance counts one reflection more for a point or a beam, at which it aims, than for what it finds by looking"
                " around; this scene has both and limits reflections")
    crowded = radiance_apertures.crowded(scene, lamps(scene)) if planned.aperture else None
    return crowded or transport.unsupported(scene, BOUNCES)


def lamps(scene: Scene) -> list[Any]:
    """Lights and surfaces that have a shape and emit from its outside and do nothing else."""
    lights = [light for light in scene.lights if isinstance(light, AreaLight)]
    return lights + [surface for surface in scene.surfaces if is_lamp(surface, scene)]


def is_lamp(surface: Surface, scene: Scene) -> bool:
    """Whether a surface emits from its outside and reflects nothing in this scene."""
    dark = not scene.reflects or surface.reflectance == 0
    return bool(surface.radiance) and dark and surface.side == "outside"


def is_parallelogram(shape: Shape) -> bool:
    """Whether Radiance samples a lamp of this shape evenly."""
    if not isinstance(shape, Polygon) or len(shape.vertices) != 4:
        return False
    a, b, c, d = np.array(shape.vertices)
    return float(np.linalg.norm(a + c - b - d)) <= 1e-9 * float(np.linalg.norm(c - a))


def _is_lone_ball(scene: Scene) -> bool:
    """Whether all light is that of a ball which the whole film sees above its horizon: then E = pi L (R/d)^2 cos(theta), d and
    theta being those of its middle (Nusselt), is what Radiance computes from the ball's middle and its cross-section."""
    if scene.surfaces or len(scene.lights) != 1 or isinstance(scene.film, CameraFilm):
        return False
    ball, film = getattr(scene.lights[0], "shape", None), scene.film
    if not isinstance(ball, Sphere):
        return False
    places, normals = (film.positions, film.normals) if isinstance(film, PointsFilm) else ([film.origin], [film.normal])
    heights = ((ball.center - np.array(places)) * unit(np.array(normals))).sum(axis=1)
    return bool((heights >= ball.radius).all())


def _around(scene: Scene) -> list[Any]:
    """What is found by looking around only: skies, walls that glow and caps that shine."""
    glowing = [surface for surface in scene.surfaces if surface.radiance and not is_lamp(surface, scene)]
    skies = [light for light in scene.lights if isinstance(light, Environment | OvercastSky)]
    return skies + glowing + [lamp for lamp in lamps(scene) if isinstance(lamp.shape, Cap)]


def _suns(scene: Scene) -> list[SunDisc]:
    return [light for light in scene.lights if isinstance(light, SunDisc)]
