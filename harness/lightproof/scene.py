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

from lightproof import checked, geometry
from lightproof.checked import Checked, SceneError
from lightproof.geometry import Shape, Vec3

TAGS = ("direct", "shadow", "furnace", "interreflection", "solid-angle", "hard", "quick", "nightly")


def _shape() -> Any:
    def check(value: Any) -> Shape:
        if not isinstance(value, tuple(geometry.SHAPES.values())):
            raise SceneError("", f"{checked.shown(value)} is not a shape; give one of {', '.join(geometry.SHAPES)}")
        return value

    return checked.rule(check, {"$ref": "#/$defs/shape"})


@dataclass(frozen=True)
class AreaLight(Checked):
    """A surface that emits `radiance` [W/(m2 sr)] from its front, the same in every direction, and reflects nothing."""

    TAG = ("kind", "area")

    id: str = checked.identifier()
    shape: Shape = _shape()
    radiance: float = checked.number(least=0)


@dataclass(frozen=True)
class PointLight(Checked):
    """A point that emits `intensity` [W/sr], the same in every direction."""

    TAG = ("kind", "point")

    id: str = checked.identifier()
    position: Vec3 = checked.vector()
    intensity: float = checked.number(least=0)


@dataclass(frozen=True)
class DirectionalLight(Checked):
    """A collimated beam; `direction` is that of travel, `irradiance` [W/m2] that of a plane across the beam."""

    TAG = ("kind", "directional")

    id: str = checked.identifier()
    direction: Vec3 = checked.direction()
    irradiance: float = checked.number(least=0)


@dataclass(frozen=True)
class Environment(Checked):
    """Uniform `radiance` [W/(m2 sr)] from every direction, or from those with z > 0 only (`extent = "upper"`)."""

    TAG = ("kind", "environment")

    id: str = checked.identifier()
    radiance: float = checked.number(least=0)
    extent: str = checked.choice("sphere", "upper", default="sphere")


@dataclass(frozen=True)
class SunDisc(Checked):
    """A distant disc of `radiance` [W/(m2 sr)] within `half_angle` [degrees] around where its light comes from;
    `direction` is that of travel."""

    TAG = ("kind", "environment")

    id: str = checked.identifier()
    radiance: float = checked.number(least=0)
    direction: Vec3 = checked.direction()
    half_angle: float = checked.number(above=0, most=90)


@dataclass(frozen=True)
class OvercastSky(Checked):
    """The CIE standard overcast sky above z = 0: radiance `zenith_radiance` (1 + 2 sin(elevation)) / 3 [W/(m2 sr)]."""

    TAG = ("kind", "environment")

    id: str = checked.identifier()
    zenith_radiance: float = checked.number(least=0)
    sky: str = checked.choice("cie-overcast", default="cie-overcast")


Light = AreaLight | PointLight | DirectionalLight | Environment | SunDisc | OvercastSky


@dataclass(frozen=True)
class Surface(Checked):
    """A Lambertian surface of `reflectance`, black behind; it may emit a `radiance` [W/(m2 sr)] of its own."""

    TAG = ("kind", "lambertian")

    id: str = checked.identifier()
    shape: Shape = _shape()
    reflectance: float = checked.number(least=0, most=1)
    radiance: float = checked.number(least=0, default=0.0)
    side: str = checked.choice("outside", "inside", default="outside")

    def check(self) -> None:
        if self.side == "inside" and not isinstance(self.shape, geometry.Sphere | geometry.Cylinder | geometry.Cap):
            raise SceneError("side", "only a sphere, a cap or a cylinder has an inside; turn the vertices or the normal round")


@dataclass(frozen=True)
class PlaneFilm(Checked):
    """A rectangle of cells; a cell's value is the mean irradiance over its area. Row r, column c starts at
    origin + u c/columns + v r/rows; the receiving side is u x v."""

    TAG = ("kind", "plane")

    quantity: str = checked.choice("irradiance")
    origin: Vec3 = checked.vector()
    u: Vec3 = checked.direction()
    v: Vec3 = checked.direction()
    resolution: tuple[int, int] = checked.resolution()

    def check(self) -> None:
        u, v = geometry.unit(self.u), geometry.unit(self.v)
        if np.linalg.norm(np.cross(u, v)) < geometry.FRAME:
            raise SceneError("v", "v is parallel to u; give two directions that span a plane")

    @property
    def grid(self) -> tuple[int, int]:
        """(rows, columns)."""
        return self.resolution[::-1]

    @property
    def normal(self) -> np.ndarray:
        """Unit normal of the receiving side, (3,)."""
        return geometry.unit(np.cross(geometry.unit(self.u), geometry.unit(self.v)))


@dataclass(frozen=True)
class PointsFilm(Checked):
    """Points that receive: irradiance on the side of `normals`, or the solid angle of all lights [sr] (without normals:
    from the whole sphere)."""

    TAG = ("kind", "points")

    quantity: str = checked.choice("irradiance", "solid_angle")
    positions: tuple[Vec3, ...] = checked.vectors(least=1)
    normals: tuple[Vec3, ...] | None = checked.vectors(least=1, each=checked.to_direction, default=None)

    def check(self) -> None:
        if self.normals is None and self.quantity == "irradiance":
            raise SceneError("normals", "irradiance needs a normal for each position")
        if self.normals is not None and len(self.normals) != len(self.positions):
            raise SceneError("normals", f"{len(self.normals)} normals for {len(self.positions)} positions; give as many of each")

    @property
    def grid(self) -> tuple[int, int]:
        """(1, points)."""
        return 1, len(self.positions)


@dataclass(frozen=True)
class CameraFilm(Checked):
    """A pinhole camera without near clip; a pixel's value is the mean radiance over its square, uniform in film area.
    Row 0 on top, columns along (target - origin) x up. `fov` [degrees] (perspective) or `width` [m] (orthographic) is
    that across all columns; pixels are square."""

    TAG = ("kind", "camera")

    quantity: str = checked.choice("radiance")
    projection: str = checked.choice("perspective", "orthographic")
    origin: Vec3 = checked.vector()
    target: Vec3 = checked.vector()
    up: Vec3 = checked.direction()
    resolution: tuple[int, int] = checked.resolution()
    fov: float = checked.number(least=0, most=179, default=0.0)
    width: float = checked.number(least=0, default=0.0)

    def check(self) -> None:
        geometry.camera_frame(self.origin, self.target, self.up)
        needed, other = ("fov", "width") if self.projection == "perspective" else ("width", "fov")
        if not getattr(self, needed) or getattr(self, other):
            raise SceneError(needed, f"a {self.projection} camera takes {needed}, greater than 0, and no {other}")

    @property
    def grid(self) -> tuple[int, int]:
        """(rows, columns)."""
        return self.resolution[::-1]

    @property
    def half_extent(self) -> tuple[float, float]:
        """Half width and half height of the film: as tangents (perspective) or in metres (orthographic)."""
        half = math.tan(math.radians(self.fov) / 2) if self.projection == "perspective" else self.width / 2
        columns, rows = self.resolution
        return half, half * rows / columns


Film = PlaneFilm | PointsFilm | CameraFilm


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
