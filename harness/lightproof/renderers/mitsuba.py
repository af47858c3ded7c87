"""Mitsuba 3, in the configurations of mitsuba_configurations.py.

Its units are radiometric (radiance, intensity, irradiance, per channel) and its rectangles, disks, spheres and cylinders
are analytic; like a scene's they emit and reflect on the front only.
"""

from __future__ import annotations

import importlib.metadata
import math
import os
import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from lightproof.method import Method, Rendering
from lightproof.renderers import half_sky, importing, mitsuba_configurations, mitsuba_shapes, options, transport, views
from lightproof.renderers.mitsuba_configurations import CONFIGURATIONS, integrator
from lightproof.renderers.views import View
from lightproof.scene import AreaLight, DirectionalLight, Environment, Light, PointLight, Scene, Surface

PASS = 1024  # samples per pass: the film adds up in float32 and is off by 5e-5 after 4,096 samples
WAVEFRONT = 2**24  # paths at a time
BAND = 400, 700  # nm: a flat band, over which spectral radiance is spread and the spectral variant's film adds up
FAR = 1e4  # m: Mitsuba's own far clip, beyond which only scenes seen from farther away go
LLVM = "karellen-llvm-core"


class Mitsuba(Method):
    """Mitsuba 3 with the cheapest of its integrators that is exact for the scene."""

    def __init__(self, name: str, threads: int):
        super().__init__(name, threads)
        self.configuration = options.chosen(name, CONFIGURATIONS)
        self.variant = self.configuration.variant

    def open(self) -> None:
        if self.variant.startswith("llvm"):
            os.environ.setdefault("DRJIT_LIBLLVM_PATH", llvm_library())
        self.mi = importing.renderer("mitsuba", "mitsuba")
        self.dr = importing.renderer("drjit", "mitsuba")
        self.mi.set_variant(self.variant)
        self.mi.set_log_level(self.mi.LogLevel.Error)
        self.dr.set_thread_count(self.threads)

    def version(self) -> str:
        return self.mi.__version__

    def settings(self) -> Mapping[str, Any]:
        return {"variant": self.variant, "integrator": self.integrator, "sampler": self.configuration.sampler, "filter": "box",
                "film": self._film()["type"], "samples_per_pass": PASS}

    def unsupported(self, scene: Scene) -> str | None:
        for light in scene.lights:
            if not isinstance(light, AreaLight | PointLight | DirectionalLight | Environment):
                return "Mitsuba is not given sun discs or overcast skies yet"
            if self.spectral and getattr(light, "extent", "sphere") == "upper":
                return "Mitsuba's spectral sky map has the colour of daylight, and no flat spectrum"
        search = mitsuba_configurations.unsupported(scene, self.configuration.search)
        return search or transport.unsupported(scene) or views.unsupported(scene)

    def caveat(self, scene: Scene) -> str:
        return mitsuba_configurations.caveat(scene, self.integrator)

    def prepare(self, scene: Scene) -> Mapping[str, float]:
        start = time.perf_counter()
        self.rendered: set[int] = set()  # samples that films of this scene had
        self.views = views.views(scene)
        self.integrator = integrator(scene, self.configuration.search)
        self.sampler = self.mi.load_dict({"type": self.configuration.sampler})
        world = {light.id: self._light(light) for light in scene.lights}
        world |= {surface.id: self._surface(surface) for surface in scene.surfaces}
        # Mitsuba 3.9 forgets the bounds of meshes that it joins to optimise, and then a sky shines through them.
        self.scenes = [self.mi.load_dict(world | self._view(view), optimize=False) for view in self.views]
        return {"setup": time.perf_counter() - start}

    def render(self, samples: int, seed: int) -> Rendering:
        columns, rows = self.views[0].resolution
        passes = math.ceil(samples / max(1, min(PASS, WAVEFRONT // (columns * rows))))
        per_pass = self._strata(math.ceil(samples / passes))
        seeds = np.random.SeedSequence(seed).generate_state(passes * len(self.views)).reshape(-1, passes)
        self._watch(samples)
        film = [view.elements(np.mean([self._image(scene, per_pass, each) for each in row], axis=0))
                for view, scene, row in zip(self.views, self.scenes, seeds, strict=True)]
        return Rendering(np.concatenate(film), samples=passes * per_pass, seconds={"compile": self._compiling()})

    def _image(self, scene: Any, samples: int, seed: int) -> np.ndarray:
        return np.array(self.mi.render(scene, spp=samples, seed=int(seed)), float)[:, :, 0]

    def _strata(self, samples: int) -> int:
        """What the sampler makes of a number of samples: a square, a near square, a power of two."""
        self.sampler.set_sample_count(samples)
        return self.sampler.sample_count()

    def _watch(self, samples: int) -> None:
        """Keep a history of kernels where films of so many samples are new, and their kernels may be: it takes a tenth of the
        time that a film takes."""
        self.dr.set_flag(self.dr.JitFlag.KernelHistory, samples not in self.rendered)
        self.dr.kernel_history_clear()
        self.rendered.add(samples)

    def _compiling(self) -> float:
        """Seconds spent on kernels since they are watched; none where they are not."""
        return sum(kernel.get("codegen_time", 0) + kernel.get("backend_time", 0) for kernel in self.dr.kernel_history()) / 1e3

    def _view(self, view: View) -> dict[str, Any]:
        columns, rows = view.resolution
        film = {"width": columns, "height": rows, "rfilter": {"type": "box"}, "component_format": "float32", **self._film()}
        clip = {"near_clip": view.near, "far_clip": max(FAR, 1e3 * view.near)}
        camera = {**self._lens(view), **clip, "film": film, "sampler": {"type": self.configuration.sampler}}
        built = {"type": "scene", "integrator": self.integrator, "film-camera": camera}
        if view.receiver:
            content = {"bsdf": diffuse(view.receiver.reflectance)}
            built["film-receiver"] = mitsuba_shapes.rectangle(self.mi, view.receiver.corners, content)
        return built

    def _film(self) -> dict[str, Any]:
        if self.spectral:
            return {"type": "specfilm", "band": {"type": "spectrum", "value": [(end, 1.0) for end in BAND]}}
        return {"type": "hdrfilm", "pixel_format": "rgb" if self.variant.endswith("rgb") else "luminance"}

    def _lens(self, view: View) -> dict[str, Any]:
        columns, rows = view.resolution
        width, height = view.half
        place = self.mi.ScalarTransform4f().look_at(origin=view.origin, target=view.target, up=view.up)
        if view.projection == "perspective":
            return {"type": "perspective", "fov": 2 * math.degrees(math.atan(width)), "fov_axis": "x", "to_world": place}
        scale = self.mi.ScalarTransform4f().scale([width, height * columns / rows, 1])
        return {"type": "orthographic", "to_world": place @ scale}

    def _light(self, light: Light) -> Any:
        match light:
            case AreaLight():
                return mitsuba_shapes.build(self.mi, light.shape, {"bsdf": diffuse(0), "emitter": self._glow(light.radiance)})
            case PointLight():
                return {"type": "point", "position": list(light.position), "intensity": self._spectrum(light.intensity)}
            case DirectionalLight():
                return {"type": "directional", "direction": list(light.direction), "irradiance": self._spectrum(light.irradiance)}
            case Environment(extent="sphere"):
                return {"type": "constant", "radiance": self._spectrum(light.radiance)}
            case Environment():
                return self._half_sky(light.radiance)

    def _half_sky(self, radiance: float) -> dict[str, Any]:
        rows = np.repeat(half_sky.picture(radiance)[..., None], 3, axis=2)
        upright = self.mi.ScalarTransform4f().rotate([1, 0, 0], 90)
        return {"type": "envmap", "bitmap": self.mi.Bitmap(rows), "to_world": upright}

    def _surface(self, surface: Surface) -> Any:
        content = {"bsdf": diffuse(surface.reflectance)} | ({"emitter": self._glow(surface.radiance)} if surface.radiance else {})
        return mitsuba_shapes.build(self.mi, surface.shape, content, surface.side == "inside")

    def _glow(self, radiance: float) -> dict[str, Any]:
        return {"type": "area", "radiance": self._spectrum(radiance)}

    def _spectrum(self, value: float) -> Any:
        """A light's value; as a spectrum, its density [1/nm] over the band that the film adds up."""
        return {"type": "uniform", "value": value / (BAND[1] - BAND[0])} if self.spectral else value

    @property
    def spectral(self) -> bool:
        """Whether light has wavelengths."""
        return self.variant.endswith("spectral")


def diffuse(reflectance: float) -> dict[str, Any]:
    """A Lambertian front; the back is black."""
    return {"type": "diffuse", "reflectance": float(reflectance)}


def llvm_library() -> str:
    """Path of the LLVM library that the package `karellen-llvm-core` brings; others of the system may abort Dr.Jit."""
    try:
        files = importlib.metadata.files(LLVM) or []
    except importlib.metadata.PackageNotFoundError:
        raise importing.missing(LLVM, "mitsuba") from None
    libraries = [file for file in files if file.name.startswith("libLLVM")]
    if not libraries:
        raise importing.missing(LLVM, "mitsuba")
    return str(libraries[0].locate().resolve())
