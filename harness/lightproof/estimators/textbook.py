"""The textbook's formulas as a method: what stability buys is seen beside them. Deliberately naive; see `formulas`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from lightproof import geometry
from lightproof.estimators import formulas
from lightproof.estimators.convex import is_convex
from lightproof.estimators.estimator import Estimator
from lightproof.estimators.interiors import is_inside
from lightproof.estimators.options import Choices, chosen
from lightproof.method import Rendering
from lightproof.scene import AreaLight, PointsFilm, Scene, SunDisc

LIT = geometry.Polygon | geometry.Disk | geometry.Sphere


def no_elements(scene: Scene) -> str | None:
    return None if isinstance(scene.film, PointsFilm) else "the textbook's formulas are for points"


def no_other_lights(scene: Scene) -> str | None:
    others = [light for light in scene.lights if not isinstance(light, SunDisc) and not isinstance(shape(light), LIT)]
    return f"it prints no formula for a light like '{others[0].id}'" if others else None


def no_mixed_interior(scene: Scene) -> str | None:
    if scene.lights or len(scene.surfaces) > 1 or not isinstance(scene.surfaces[0].shape, geometry.Sphere):
        return "of reflected light it prints the sphere that glows and reflects evenly"
    return None


def no_hard_blockers(scene: Scene) -> str | None:
    if not scene.surfaces:
        return None
    shapes = [*map(shape, scene.lights), *(surface.shape for surface in scene.surfaces)]
    if scene.reflects or scene.film.quantity == "solid_angle" or len(scene.lights) > 1 or not all(map(flat_and_convex, shapes)):
        return "before surfaces it prints the direct light of one convex polygon behind others"
    return None


def no_unprinted_angles(scene: Scene) -> str | None:
    if scene.film.quantity != "solid_angle":
        return None
    disks = [light for light in scene.lights if isinstance(shape(light), geometry.Disk)]
    x = np.array(scene.film.positions)
    if any(np.cross(x - np.array(light.shape.center), geometry.unit(light.shape.normal)).any() for light in disks):
        return "it prints the solid angle of a disk from its axis only"
    return None if len(scene.lights) == 1 else "it prints the solid angle of one light"


def shape(light: Any) -> geometry.Shape | None:
    return light.shape if isinstance(light, AreaLight) else None


def flat_and_convex(one: geometry.Shape | None) -> bool:
    if not isinstance(one, geometry.Polygon):
        return False
    corners = np.array(one.vertices)
    flat = (corners - corners[0]) @ np.stack(geometry.tangents(one.normal), axis=1)
    return is_convex(flat, range(len(flat)))


class Textbook(Estimator):
    """Polygons, disks, spheres and suns over points, a convex polygon behind others, the glowing sphere; one formula each."""

    deterministic = True
    choices: ClassVar[Choices] = {"precision": {"float64": np.float64, "float32": np.float32}}

    def __init__(self, name: str, threads: int):
        """Raises ValueError on an option that is not known."""
        super().__init__(name, threads)
        self.precision = chosen(name, self.choices)["precision"]
        self.real = self.choices["precision"][self.precision]

    def settings(self) -> Mapping[str, Any]:
        return {"precision": self.precision}

    def unsupported(self, scene: Scene) -> str | None:
        inside = (no_elements, no_mixed_interior)
        outside = (no_elements, no_other_lights, no_hard_blockers, no_unprinted_angles)
        limits = inside if is_inside(scene) else outside
        return super().unsupported(scene) or next((reason for limit in limits if (reason := limit(scene))), None)

    def build(self, scene: Scene) -> None:
        self.scene = scene
        self.x = self.array(scene.film.positions)
        self.n = None if scene.film.normals is None else formulas.unit(self.array(scene.film.normals))

    def warm_up(self) -> None:
        """Nothing is compiled."""

    @np.errstate(all="ignore")
    def render(self, samples: int, seed: int) -> Rendering:
        if is_inside(self.scene):
            return Rendering(np.full(self.size, self.interior()), 1)
        if self.scene.film.quantity == "solid_angle":
            return Rendering(sum((self.solid_angle(light) for light in self.scene.lights), np.zeros(self.size)), 1)
        light = sum((np.maximum(self.irradiance(light), 0) for light in self.scene.lights), np.zeros(self.size))
        return Rendering(light, 1)

    def array(self, values: Any) -> np.ndarray:
        """In the method's precision, world coordinates and all; a number as (1,), for a scalar would not keep it."""
        return np.atleast_1d(np.asarray(values, float)).astype(self.real)

    def interior(self) -> np.ndarray:
        """E = pi L of the evenly glowing sphere [W/m2]."""
        wall, bounces = self.scene.surfaces[0], self.scene.max_bounces
        reflected = formulas.glow(self.array(wall.reflectance), None if bounces == "all" else bounces)
        return np.pi * self.array(wall.radiance) * reflected

    def irradiance(self, light: AreaLight | SunDisc) -> np.ndarray:
        """(n,) [W/m2]."""
        radiance = np.pi * self.array(light.radiance)
        match shape(light):
            case geometry.Polygon(vertices=corners):
                return radiance * self.polygon(self.array(corners))
            case geometry.Disk() as one:
                axis = formulas.unit(self.array(one.normal))
                return radiance * formulas.disk(self.array(one.center), axis, self.array(one.radius), self.x, self.n)
            case geometry.Sphere() as one:
                return radiance * formulas.sphere(self.array(one.center), self.array(one.radius), self.x, self.n)
        towards = -formulas.unit(self.array(light.direction))
        return radiance * np.sin(np.radians(self.array(light.half_angle))) ** 2 * formulas.dot(self.n, towards)

    def polygon(self, corners: np.ndarray) -> np.ndarray:
        """Form factor of what the blockers leave: theirs is taken off one by one."""
        factor = np.maximum(formulas.polygon(corners, self.x, self.n), 0)
        for blocker in (self.array(surface.shape.vertices) for surface in self.scene.surfaces):
            parts = [formulas.hidden(corners, blocker, x) for x in self.x]
            lost = [formulas.polygon(part, x[None], n[None])[0] if len(part) else self.real(0)
                    for part, x, n in zip(parts, self.x, self.n, strict=True)]
            factor = factor - np.array(lost)
        return factor

    def solid_angle(self, light: AreaLight | SunDisc) -> np.ndarray:
        """(n,) [sr]; the receiver's horizon cuts nothing."""
        match shape(light):
            case geometry.Polygon(vertices=corners):
                return np.maximum(formulas.polygon_angle(self.array(corners), self.x), 0)
            case geometry.Disk() as one:
                axis = formulas.unit(self.array(one.normal))
                return formulas.disk_angle(self.array(one.center), axis, self.array(one.radius), self.x)
            case geometry.Sphere() as one:
                return formulas.sphere_angle(self.array(one.center), self.array(one.radius), self.x)
        return np.broadcast_to(2 * np.pi * (1 - np.cos(np.radians(self.array(light.half_angle)))), (self.size,))
