"""What a scene is: lights, surfaces and one film, frozen and validated; SI units, right-handed, z up.

Conventions (all of them in scenes/README.md): lights and surfaces are opaque, emit and reflect on their front only, and
are black behind. A plane or points film is virtual: it neither blocks nor reflects. `max_bounces` counts reflections
before light arrives at the film.
"""

from __future__ import annotations

import hashlib
import json
import math
from dataclasses import dataclass, field, replace
from itertools import combinations
from typing import Any

import numpy as np

from lightproof import geometry
from lightproof.checked import SceneError
from lightproof.lights import AreaLight, DirectionalLight, Environment, Light, OvercastSky, PointLight, SunDisc, Surface
from lightproof.receivers import CameraFilm, Film, PlaneFilm, PointsFilm

__all__ = [
    "TAGS", "AreaLight", "CameraFilm", "DirectionalLight", "Environment", "Film", "Light", "OvercastSky", "PlaneFilm",
    "PointLight", "PointsFilm", "Scene", "SunDisc", "Surface",
]  # fmt: skip

TAGS = ("direct", "shadow", "furnace", "interreflection", "solid-angle", "hard", "quick", "nightly")


@dataclass(frozen=True)
class Scene:
    """One case of one scene file. `tolerance` is a fraction of the scale that `tolerance_scale` names: "max" (the film's
    largest reference value), "element" (each element's own) or a number in the film's unit."""

    id: str
    case: str
    title: str
    tests: str
    tags: tuple[str, ...]
    lights: tuple[Light, ...]
    surfaces: tuple[Surface, ...]
    film: Film
    max_bounces: int | str
    tolerance: float
    tolerance_scale: str | float = "max"
    digest: str = field(init=False, default="")

    def __post_init__(self) -> None:
        ids = [item.id for item in (*self.lights, *self.surfaces)]
        for duplicate in {name for name in ids if ids.count(name) > 1}:
            raise SceneError("id", f"'{duplicate}' names two things; ids must differ")
        if self.max_bounces == "all" and (_white_ball(self.surfaces) or _white_room(self.surfaces)):
            raise SceneError("max_bounces", 'a closed surface of reflectance 1 never loses light; give a number instead of "all"')
        object.__setattr__(self, "digest", _digest(self))

    def to_table(self) -> dict[str, Any]:
        """The scene as its file would write it, without the cases; `scene_file.from_table` reads it back."""
        return {
            "title": self.title,
            **({"tests": self.tests} if self.tests else {}),
            "tags": list(self.tags),
            "max_bounces": self.max_bounces,
            "tolerance": self.tolerance,
            "tolerance_scale": self.tolerance_scale,
            "light": [light.to_table() for light in self.lights],
            "surface": [surface.to_table() for surface in self.surfaces],
            "film": self.film.to_table(),
        }

    @property
    def tangible(self) -> Scene:
        """The scene without its polygons that have no area: these neither shine nor block."""
        lights, surfaces = (tuple(item for item in items if not _is_degenerate(item)) for items in (self.lights, self.surfaces))
        return self if (lights, surfaces) == (self.lights, self.surfaces) else replace(self, lights=lights, surfaces=surfaces)

    @property
    def name(self) -> str:
        """`id`, with the case where it is not the base: square-light, square-light:far."""
        return self.id if self.case == "base" else f"{self.id}:{self.case}"

    @property
    def size(self) -> int:
        """Number of film elements n, row-major."""
        return math.prod(self.film.grid)

    @property
    def reflects(self) -> bool:
        """Whether any light reaches the film after a reflection."""
        return self.max_bounces != 0 and any(surface.reflectance > 0 for surface in self.surfaces)


def _is_degenerate(item: Light | Surface) -> bool:
    shape = getattr(item, "shape", None)
    return isinstance(shape, geometry.Polygon) and shape.is_degenerate


def _white_ball(surfaces: tuple[Surface, ...]) -> bool:
    """Whether a whole white sphere, or two white caps that make one, face inward."""
    white = [surface.shape for surface in surfaces if surface.reflectance == 1 and surface.side == "inside"]
    caps = [shape for shape in white if isinstance(shape, geometry.Cap)]
    return any(isinstance(shape, geometry.Sphere) for shape in white) or any(a.completes(b) for a, b in combinations(caps, 2))


def _white_room(surfaces: tuple[Surface, ...]) -> bool:
    """Whether white polygons close round a room: each edge is run through once either way, and the fronts face inward."""
    polygons = [surface for surface in surfaces if isinstance(surface.shape, geometry.Polygon) and not _is_degenerate(surface)]
    white = [surface.shape for surface in polygons if surface.reflectance == 1]
    edges = [edge for shape in white for edge in zip(shape.vertices, (*shape.vertices[1:], shape.vertices[0]), strict=True)]
    size = max((abs(component) for shape in white for vertex in shape.vertices for component in vertex), default=1.0)
    walls = [np.array(shape.vertices) / size for shape in white]
    volume = sum(float(np.dot(corners[0], geometry.vector_area(corners))) for corners in walls)
    return sorted(edges) == sorted((end, start) for start, end in edges) and volume < 0


def _digest(scene: Scene) -> str:
    """SHA-256 of what decides the light: lights, surfaces, film and max_bounces, as canonical JSON with hex floats."""
    table = scene.to_table()
    physics = {key: _hex(table[key]) for key in ("light", "surface", "film", "max_bounces")}
    return hashlib.sha256(json.dumps(physics, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def _hex(value: Any) -> Any:
    match value:
        case float():
            return value.hex()
        case dict():
            return {key: _hex(item) for key, item in value.items()}
        case list():
            return [_hex(item) for item in value]
        case _:
            return value
