"""LuxCore, through the module `pyluxcore`, on the CPU: its path tracer (`luxcore`, `luxcore/random`) or its bidirectional
one (`luxcore/bidirectional`).

It stops when it sees that it has samples enough, a few too many; they are counted. Which sample comes first is up to its
threads: films of one seed differ in their last digits, and in their last samples.
"""

from __future__ import annotations

import importlib
import math
import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from lightproof.geometry import Disk, Polygon
from lightproof.method import Method, Rendering
from lightproof.renderers import importing, luxcore_scene, mesh, options, tessellation, transport, views
from lightproof.renderers.luxcore_scene import Stage
from lightproof.renderers.views import View
from lightproof.scene import AreaLight, DirectionalLight, Environment, PointLight, Scene

BEFORE = ("OpenEXR", "scipy.spatial")  # compiled modules that are used later; loaded after pyluxcore, each aborts the process
PASS = 4096  # samples a pixel at a time: the film adds up in float32 and is off by 2e-5 after these, by 7e-4 after 65,536
SMALLEST = 8  # pixels along a side: of a smaller picture each pixel gets many samples more than were asked for
POLL = 0.001  # s

BIDIRECTIONAL = "bidirectional"
ENGINES = {
    "": {"renderengine.type": "PATHCPU", "sampler.type": "SOBOL"},
    "random": {"renderengine.type": "PATHCPU", "sampler.type": "RANDOM"},
    BIDIRECTIONAL: {"renderengine.type": "BIDIRCPU", "sampler.type": "SOBOL"},
}


class LuxCore(Method):
    """LuxCore with everything off that trades exactness for looks."""

    def __init__(self, name: str, threads: int):
        super().__init__(name, threads)
        self.engine = options.chosen(name, ENGINES)

    def open(self) -> None:
        for module in BEFORE:
            importlib.import_module(module)
        self.lux = importing.renderer("pyluxcore", "luxcore")
        self.lux.Init()

    def version(self) -> str:
        return self.lux.Version()

    def settings(self) -> Mapping[str, Any]:
        return {**self.engine, "path.pathdepth.total": self.config["path.pathdepth.total"],
                "film.filter.type": self.config["film.filter.type"], "sphere_triangles": 20 * 4**mesh.SPHERE}

    def unsupported(self, scene: Scene) -> str | None:
        for light in scene.lights:
            if not isinstance(light, AreaLight | PointLight | DirectionalLight | Environment):
                return "LuxCore is not given sun discs or overcast skies yet"
        if self.engine == ENGINES[BIDIRECTIONAL] and _stops_early(scene):
            return "LuxCore's bidirectional tracer cannot stop after a number of reflections: it joins paths of every two lengths"
        return transport.unsupported(scene) or views.unsupported(scene)

    def caveat(self, scene: Scene) -> str:
        known = []
        if self.engine == ENGINES[BIDIRECTIONAL] and any(isinstance(light, DirectionalLight) for light in scene.lights):
            known.append("LuxCore's bidirectional tracer weights directional lights wrongly, by an amount that depends on where"
                         " the camera stands; its path tracer is right.")
        if self.threads > 1:
            known.append("LuxCore's threads add to the weights of pixels without a lock: now and then some are lost, and a pixel"
                         " is too bright by the share of a few samples.")
        return " ".join(known)

    def tessellation(self, scene: Scene) -> np.ndarray | None:
        native = luxcore_scene.lamps(scene)
        return tessellation.difference(scene, tessellation.meshes(scene, native, luxcore_scene.LAMP_CORNERS))

    def prepare(self, scene: Scene) -> Mapping[str, float]:
        start = time.perf_counter()
        self.config = {**luxcore_scene.configuration(scene), **self.engine, "native.threads.count": self.threads}
        self.views = views.views(scene)
        contents = luxcore_scene.contents(scene)
        self.scenes = [self._scene(contents, luxcore_scene.seen(view, _block(view))) for view in self.views]
        return {"setup": time.perf_counter() - start}

    def render(self, samples: int, seed: int) -> Rendering:
        per_pixel = math.ceil(samples / _block(self.views[0]) ** 2)
        passes = math.ceil(per_pixel / PASS)
        seeds = np.random.SeedSequence(seed).generate_state(passes * len(self.views)).reshape(-1, passes) >> 1 | 1
        drawn = [self._film(view, scene, math.ceil(per_pixel / passes), row)
                 for view, scene, row in zip(self.views, self.scenes, seeds, strict=True)]
        films, taken = zip(*drawn, strict=True)
        return Rendering(np.concatenate(films), samples=round(np.mean(taken)))

    def _film(self, view: View, scene: Any, samples: int, seeds: np.ndarray) -> tuple[np.ndarray, float]:
        """Film elements (n,) from one pass of `samples` a pixel for each seed, and the samples that an element really has."""
        images, taken = zip(*(self._image(view, scene, samples, seed) for seed in seeds), strict=True)
        return view.elements(views.pooled(np.mean(images, axis=0), _block(view))), _block(view) ** 2 * sum(taken)

    def _scene(self, *stages: Stage) -> Any:
        made = self.lux.Scene()
        for stage in stages:
            for name, shape in stage.meshes.items():
                made.DefineMesh(name, _tuples(shape.vertices), _tuples(shape.triangles), None, None, None, None)
            for name, image in stage.images.items():
                made.DefineImageMap(name, image, 1.0, 1, *image.shape[::-1])
            made.Parse(self._properties(stage.properties))
        return made

    def _image(self, view: View, scene: Any, samples: int, seed: int) -> tuple[np.ndarray, float]:
        """The picture (rows, columns), row 0 on top, and the samples that a pixel of it really has."""
        columns, rows = (count * _block(view) for count in view.resolution)
        asked = {"film.width": columns, "film.height": rows, "batch.haltspp": samples, "renderengine.seed": int(seed)}
        session = self.lux.RenderSession(self.lux.RenderConfig(self._properties(self.config | asked), scene))
        session.Start()
        while not session.HasDone():
            time.sleep(POLL)
            session.UpdateStats()  # without it nothing is ever done
        session.Stop()
        pixels = np.empty((rows, columns, 3), np.float32)
        session.GetFilm().GetOutputFloat(self.lux.FilmOutputType.RGB, pixels, 0)
        taken = session.GetStats().Get("stats.renderengine.total.samplecount").GetFloat() / (columns * rows)
        return pixels[::-1, :, 0].astype(float), taken

    def _properties(self, values: Mapping[str, Any]) -> Any:
        made = self.lux.Properties()
        for name, value in values.items():
            made.Set(self.lux.Property(name, value))
        return made


def _stops_early(scene: Scene) -> bool:
    """Whether light is not to be followed as far as it goes; it goes no further than once off a single plane."""
    mirrors = [surface.shape for surface in scene.surfaces if surface.reflectance]
    once = len(mirrors) == 1 and isinstance(mirrors[0], Polygon | Disk)
    return scene.reflects and scene.max_bounces != "all" and not once


def _block(view: View) -> int:
    """Pixels along each side of a film element."""
    return math.ceil(SMALLEST / min(view.resolution))


def _tuples(rows: np.ndarray) -> list[tuple]:
    return list(map(tuple, rows.tolist()))
