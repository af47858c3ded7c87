"""Blender Cycles, through the module `bpy`, on the CPU, in the configurations of `CONFIGURATIONS`."""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from lightproof.method import Method, Rendering
from lightproof.quiet import quiet
from lightproof.renderers import cycles_scene, importing, mesh, options, scratch, tessellation, transport, views
from lightproof.renderers.views import View
from lightproof.scene import AreaLight, CameraFilm, DirectionalLight, Environment, PointLight, Scene

BOUNCES = 1024  # Cycles takes no more
SMALLEST = 4  # pixels: Blender makes every image at least this wide and high

CYCLES = {
    "use_adaptive_sampling": False, "use_denoising": False, "time_limit": 0, "sample_clamp_direct": 0, "sample_clamp_indirect": 0,
    "light_sampling_threshold": 0, "use_light_tree": False, "blur_glossy": 0, "use_fast_gi": False, "use_guiding": False,
    "pixel_filter_type": "BOX", "sampling_pattern": "TABULATED_SOBOL", "auto_scrambling_distance": False, "use_auto_tile": False,
    "use_layer_samples": "IGNORE", "film_exposure": 1,
}
RENDER = {
    "engine": "CYCLES", "threads_mode": "FIXED", "use_persistent_data": True, "dither_intensity": 0, "use_compositing": False,
    "use_sequencer": False, "use_motion_blur": False, "use_simplify": False,
}
FITTING, LAMPS, MESHES = "fitting", "lamps", "meshes"


@dataclass(frozen=True)
class Configuration:
    """`changes` to `CYCLES`, and what area lights become: Blender's own lamps, meshes that emit, or what is right for the scene:
    nothing sees a lamp, and it blocks nothing."""

    emitters: str = FITTING
    changes: Mapping[str, Any] = field(default_factory=dict)


CONFIGURATIONS = {
    "": Configuration(),
    "lamp": Configuration(emitters=LAMPS),
    "mesh": Configuration(emitters=MESHES),
    "light-tree": Configuration(changes={"use_light_tree": True}),
    "blue-noise": Configuration(changes={"sampling_pattern": "BLUE_NOISE"}),
    "automatic": Configuration(changes={"sampling_pattern": "AUTOMATIC"}),
}
IMAGE = {"media_type": "IMAGE", "file_format": "OPEN_EXR", "color_mode": "RGB", "color_depth": "32", "exr_codec": "NONE"}


class Cycles(Method):
    """Cycles with everything off that trades exactness for looks."""

    def __init__(self, name: str, threads: int):
        super().__init__(name, threads)
        self.configuration = options.chosen(name, CONFIGURATIONS)

    def open(self) -> None:
        with quiet(1):
            self.bpy = importing.renderer("bpy", "cycles")
        self.folder = tempfile.TemporaryDirectory(dir=scratch.in_memory())

    def version(self) -> str:
        return self.bpy.app.version_string

    def settings(self) -> Mapping[str, Any]:
        cycles = self.sets[0].cycles
        return {"bounces": self.bounces, "emitters": LAMPS if self.lamps else MESHES, "filter": "box",
                "sampling_pattern": cycles.sampling_pattern, "light_tree": cycles.use_light_tree,
                "sphere_triangles": 20 * 4**mesh.SPHERE}

    def unsupported(self, scene: Scene) -> str | None:
        for light in scene.lights:
            if not isinstance(light, AreaLight | PointLight | DirectionalLight | Environment):
                return "Cycles is not given sun discs or overcast skies yet"
        return self._no_lamp(scene) or transport.unsupported(scene, BOUNCES) or views.unsupported(scene)

    def _no_lamp(self, scene: Scene) -> str | None:
        """Why the lamps that are asked for cannot be had, or None."""
        if self.configuration.emitters != LAMPS:
            return None
        for light in scene.lights:
            if isinstance(light, AreaLight) and not cycles_scene.has_lamp(light.shape):
                return f"Blender's lamps are spheres, disks and rectangles, and '{light.id}' is none"
        return "Blender's lamps are not seen from behind" if isinstance(scene.film, CameraFilm) else None

    def caveat(self, scene: Scene) -> str:
        has_size = any(isinstance(light, AreaLight) for light in scene.lights)
        if has_size and self.configuration.emitters == LAMPS and not _lamps_fit(scene):
            return "Cycles' lamps block no light: what would fall on the back of one passes through it."
        return ""

    def tessellation(self, scene: Scene) -> np.ndarray | None:
        lamps = [light for light in scene.lights if self.lamps and isinstance(light, AreaLight)]
        native = {light.id for light in lamps if cycles_scene.has_lamp(light.shape)}
        return tessellation.difference(scene, tessellation.meshes(scene, native))

    def prepare(self, scene: Scene) -> Mapping[str, float]:
        start = time.perf_counter()
        self.bpy.ops.wm.read_factory_settings(use_empty=True)
        self.bounces = max(transport.reflections(scene, BOUNCES) - isinstance(scene.film, CameraFilm), 0)
        self.certain = min(transport.certain(scene), self.bounces)  # then Russian roulette
        self.lamps = {LAMPS: True, MESHES: False, FITTING: _lamps_fit(scene)}[self.configuration.emitters]
        self.views = views.views(scene)
        world = cycles_scene.world(self.bpy, [light for light in scene.lights if isinstance(light, Environment)])
        contents = self._contents(scene)
        self.sets = [self._set(view, contents, world) for view in self.views]
        for one in self.sets:
            self._image(one, 1, 0)
        return {"setup": time.perf_counter() - start}

    def render(self, samples: int, seed: int) -> Rendering:
        block = _block(self.views[0]) ** 2
        per_pixel = math.ceil(samples / block)
        seeds = np.random.SeedSequence(seed).generate_state(len(self.views)) >> 1
        film = [view.elements(views.pooled(self._image(one, per_pixel, each), _block(view)))
                for view, one, each in zip(self.views, self.sets, seeds, strict=True)]
        return Rendering(np.concatenate(film), samples=per_pixel * block)

    def _contents(self, scene: Scene) -> Any:
        """A collection with the lights and surfaces."""
        collection = self.bpy.data.collections.new("contents")
        stage = cycles_scene.Stage(self.bpy, collection, self.lamps)
        for light in scene.lights:
            stage.light(light)
        for surface in scene.surfaces:
            stage.surface(surface if scene.max_bounces else replace(surface, reflectance=0.0))
        return collection

    def _set(self, view: View, contents: Any, world: Any) -> Any:
        """A Blender scene with the contents, one camera and its receiver."""
        made = self.bpy.data.scenes.new("film")
        made.collection.children.link(contents)
        stage = cycles_scene.Stage(self.bpy, made.collection, self.lamps)
        made.world, made.camera = world, stage.camera(view)
        if view.receiver:
            stage.receiver(view.receiver.corners, view.receiver.reflectance)
        self._configure(made, view)
        return made

    def _configure(self, made: Any, view: View) -> None:
        columns, rows = (count * _block(view) for count in view.resolution)
        wide = (view.half[0] / columns) / (view.half[1] / rows)
        bounces = {"max_bounces": self.bounces, "diffuse_bounces": self.bounces, "min_light_bounces": self.certain}
        size = {"resolution_x": columns, "resolution_y": rows, "resolution_percentage": 100, "threads": self.threads,
                "pixel_aspect_x": max(wide, 1.0), "pixel_aspect_y": max(1 / wide, 1.0)}
        cycles = {**CYCLES, **self.configuration.changes, **bounces}
        for owner, values in ((made.render, RENDER | size), (made.cycles, cycles), (made.render.image_settings, IMAGE)):
            for name, value in values.items():
                setattr(owner, name, value)

    def _image(self, made: Any, samples: int, seed: int) -> np.ndarray:
        import OpenEXR

        path = Path(self.folder.name) / "film.exr"
        made.cycles.samples, made.cycles.seed, made.render.filepath = samples, int(seed), str(path)
        with quiet(1):  # every render is reported there
            self.bpy.ops.render.render(write_still=True, scene=made.name)
        with OpenEXR.File(str(path)) as file:
            return np.array(file.channels()["RGB"].pixels[:, :, 0], float)


def _lamps_fit(scene: Scene) -> bool:
    """Whether a lone lamp does all that the scene's light does: nothing has to see it, or to be hidden by it."""
    alone = len(scene.lights) == 1 and not any(surface.radiance for surface in scene.surfaces)
    return alone and not scene.reflects and not isinstance(scene.film, CameraFilm)


def _block(view: View) -> int:
    """Pixels along each side of a film element."""
    return math.ceil(SMALLEST / min(view.resolution))
