"""Scenes as LuxCore says them: the properties of its files, and the meshes and images that these name.

Units as measured: a material's emission is radiance; the gain of a point light is a power, 4 pi I, and of a sphere light
too, 4 pi^2 r^2 L; that of a sharp distant light is the irradiance across the beam, of an infinite light radiance.
"""

from __future__ import annotations

from collections.abc import Container
from dataclasses import replace
from typing import Any

import numpy as np

from lightproof.geometry import Sphere
from lightproof.renderers import half_sky, mesh, transport
from lightproof.renderers.mesh import Mesh
from lightproof.renderers.views import View
from lightproof.scene import AreaLight, CameraFilm, DirectionalLight, Environment, Light, PointLight, Scene, Surface

FAR = 1e6  # clip distance [m]
LAMP_CORNERS = 256  # of a round lamp's circle: among 1,024 triangles to choose from, Sobol's points have lost their evenness
RECTANGLE = np.array([[0, 1, 2], [0, 2, 3]])


class Stage:
    """`properties` by their dotted names; `meshes`, and `images` (rows, columns) in float32, by the names that these use.
    The lights whose ids are `lamps` are LuxCore's own spheres, which nothing sees and which block nothing."""

    def __init__(self, lamps: Container[str] = ()):
        self.lamps = lamps
        self.properties: dict[str, Any] = {}
        self.meshes: dict[str, Mesh] = {}
        self.images: dict[str, np.ndarray] = {}

    def light(self, light: Light) -> None:
        """Add a light."""
        match light:
            case PointLight():
                self._lamp(light.id, "point", 4 * np.pi * light.intensity, position=list(light.position))
            case DirectionalLight():
                self._lamp(light.id, "sharpdistant", light.irradiance, direction=list(light.direction))
            case Environment(extent="sphere"):
                self._lamp(light.id, "constantinfinite", light.radiance)
            case Environment():
                self.images[light.id] = half_sky.picture(1)
                self._lamp(light.id, "infinite", light.radiance, file=light.id)
            case AreaLight(shape=Sphere() as ball) if light.id in self.lamps:
                power = 4 * np.pi**2 * ball.radius**2 * light.radiance
                self._lamp(light.id, "sphere", power, position=list(ball.center), radius=ball.radius)
            case AreaLight():
                self._body(light.id, mesh.tessellate(light.shape, corners=LAMP_CORNERS), 0.0, light.radiance)

    def surface(self, surface: Surface) -> None:
        """Add a surface that reflects and may emit. One that emits inward is not aimed at: it is wherever one looks."""
        inside = surface.side == "inside"
        self._body(surface.id, mesh.tessellate(surface.shape, inside), surface.reflectance, surface.radiance, aimed=not inside)

    def view(self, view: View, block: int) -> None:
        """Set the camera, of `block` x `block` pixels an element, and add its receiver. LuxCore's pictures are one pixel too
        high: the screen goes down by as much."""
        if view.receiver:
            self._body("film-receiver", Mesh(view.receiver.corners, RECTANGLE), view.receiver.reflectance)
        (width, height), pixel = view.half, 2 * view.half[1] / (block * view.resolution[1])
        self._set("scene.camera", type=view.projection, up=view.up.tolist(), fieldofview=90.0, cliphither=view.near, clipyon=FAR,
                  screenwindow=[-width, width, -height - pixel, height - pixel])
        self._set("scene.camera.lookat", orig=view.origin.tolist(), target=view.target.tolist())
        self._set("scene.camera.autofocus", enable=False)

    def _lamp(self, name: str, kind: str, gain: float, **fields: Any) -> None:
        self._set(f"scene.lights.{name}", type=kind, gain=[gain] * 3, **fields)

    def _body(self, name: str, shape: Mesh, reflectance: float, radiance: float = 0.0, aimed: bool = True) -> None:
        """A Lambertian front that may emit; the back is black."""
        self.meshes[name] = shape
        for side, colour in (("front", reflectance), ("back", 0.0)):
            self._set(f"scene.materials.{name}-{side}", type="matte", kd=[colour] * 3)
        self._set(f"scene.materials.{name}", type="twosided", frontmaterial=f"{name}-front", backmaterial=f"{name}-back")
        if radiance:
            self._set(f"scene.materials.{name}", emission=[radiance] * 3)
            self._set(f"scene.materials.{name}.emission.directlightsampling", type="ENABLED" if aimed else "DISABLED")
        self._set(f"scene.objects.{name}", shape=name, material=name)

    def _set(self, prefix: str, **fields: Any) -> None:
        self.properties |= {f"{prefix}.{field}": value for field, value in fields.items()}


def lamps(scene: Scene) -> set[str]:
    """The ids of sphere lights that nothing has to see, and from which nothing else has to be hidden."""
    alone = len(scene.lights) == 1 and not any(surface.radiance for surface in scene.surfaces)
    if not alone or scene.reflects or isinstance(scene.film, CameraFilm):
        return set()
    return {light.id for light in scene.lights if isinstance(light, AreaLight) and isinstance(light.shape, Sphere)}


def contents(scene: Scene) -> Stage:
    """The lights and surfaces of a scene."""
    made = Stage(lamps(scene))
    for light in scene.lights:
        made.light(light)
    for surface in scene.surfaces:
        made.surface(surface if scene.max_bounces else replace(surface, reflectance=0.0))
    return made


def seen(view: View, block: int = 1) -> Stage:
    """The camera of a view, of `block` x `block` pixels an element, and its receiver."""
    made = Stage()
    made.view(view, block)
    return made


def configuration(scene: Scene) -> dict[str, Any]:
    """All reflections that matter, Russian roulette for faint paths alone, no clamping, no filter; the raw picture."""
    depth = transport.edges(scene)
    return {
        **dict.fromkeys((f"path.pathdepth.{kind}" for kind in ("total", "diffuse", "glossy", "specular")), depth),
        "path.maxdepth": depth, "light.maxdepth": depth,  # the bidirectional tracer's
        "path.russianroulette.depth": depth + 1 - transport.reflections(scene) + transport.certain(scene),
        "path.clamping.variance.maxvalue": 0,
        "lightstrategy.type": "UNIFORM",
        "sampler.sobol.adaptive.strength": 0, "sampler.random.adaptive.strength": 0,
        "scene.epsilon.min": 1e-12,  # m: by default what is nearer than 1e-5 is not there
        "film.filter.type": "NONE",
        "film.imagepipelines.0.0.type": "NOP",
        "film.outputs.0.type": "RGB", "film.outputs.0.filename": "film.exr",
    }
