"""pyrender, as it comes: a rasteriser that draws eight bits, gamma-encoded, with the glTF surface model.

The gamma of its shader is undone and the step of its eight bits declared. Its surface (white, not metallic, roughness 1)
is taken for the Lambert surface that a user would take it for; what the Fresnel term in it costs is for verdicts to show.
"""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from lightproof import geometry
from lightproof.method import Method, Rendering
from lightproof.renderers import importing, views
from lightproof.renderers.views import View
from lightproof.scene import CameraFilm, DirectionalLight, Environment, Light, PointLight, Scene

GAMMA, FULL = 2.2, 255
FINEST = 1 - (1 - 0.5 / FULL) ** GAMMA  # half a step of the output, of the brightest that it holds
LARGEST = 4096  # pixels along a side of a frame
BRIGHT = 0.9  # of full scale: where the exposure puts the brightest pixel
PROBE = 8  # pixels along each side of an element while the exposure is looked for
DISTANCE = 100  # of the film's size: how far above the film the camera stands, to see it along its normal


class Pyrender(Method):
    """pyrender's stock renderer; the samples of an element are the pixels averaged into it."""

    deterministic = True
    precision = "uint8"

    def open(self) -> None:
        os.environ.setdefault("PYOPENGL_PLATFORM", "egl")
        self.pyrender = importing.renderer("pyrender", "pyrender")
        self.renderer = self.pyrender.OffscreenRenderer(1, 1)

    def version(self) -> str:
        return self.pyrender.__version__

    def settings(self) -> Mapping[str, Any]:
        return {"material": "white, roughness 1, taken for Lambertian", "gamma": "undone", "bits": 8,
                "exposure": f"brightest pixel at {BRIGHT} of full scale"}

    def caveat(self, scene: Scene) -> str:
        if all(isinstance(light, Environment) for light in scene.lights):
            return "pyrender's picture has 8 bits: a finer tolerance than half a step of them cannot be decided."
        return ("pyrender's material is not Lambertian: a Fresnel term takes 4 % at normal incidence, a glossy lobe adds light"
                " at grazing angles; and its picture has 8 bits.")

    def unsupported(self, scene: Scene) -> str | None:
        for light in scene.lights:
            if not isinstance(light, PointLight | DirectionalLight | Environment):
                return "pyrender has no area lights"
            if isinstance(light, Environment) and light.extent != "sphere":
                return "pyrender's ambient light comes from everywhere"
        if scene.surfaces:
            return "pyrender has no interreflection, and its point lights cast no shadows"
        if isinstance(scene.film, CameraFilm):
            return "pyrender draws no light sources"
        if scene.tolerance < FINEST:
            return (f"pyrender's 8 bits leave {100 * FINEST:.2g} % of the brightest light open, and this scene's tolerance is"
                    f" {100 * scene.tolerance:g} %")
        return views.unsupported(scene) or _stretched(scene)

    def prepare(self, scene: Scene) -> Mapping[str, float]:
        start = time.perf_counter()
        self.scene = scene
        self.views = views.views(scene)
        self.exposures = [self._exposure(view) for view in self.views]
        return {"setup": time.perf_counter() - start}

    def render(self, samples: int, seed: int) -> Rendering:
        most = LARGEST // max(self.views[0].resolution)
        side = max(1, min(round(samples**0.5), most))
        drawn = [self._draw(view, side, exposure) for view, exposure in zip(self.views, self.exposures, strict=True)]
        film, steps = (np.concatenate(parts) for parts in zip(*drawn, strict=True))
        return Rendering(film, samples=side**2, quantization=steps)

    def _draw(self, view: View, side: int, exposure: float) -> tuple[np.ndarray, np.ndarray]:
        """Film elements and half their steps, from `side` x `side` pixels each."""
        codes = self._codes(view, side, exposure)
        while codes.max() == FULL:
            exposure *= BRIGHT
            codes = self._codes(view, side, exposure)
        radiance, half_step = _linear(codes), _linear(codes + 0.5) - _linear(codes)
        return tuple(view.elements(views.pooled(image, side) / exposure) for image in (radiance, half_step))

    def _exposure(self, view: View) -> float:
        """The factor on all lights that puts the brightest pixel at BRIGHT, found by trying; 1 where no light arrives."""
        exposure = 1.0
        for _ in range(100):
            peak = float(_linear(self._codes(view, PROBE, exposure).max()))
            if 0.2 <= peak < 1:
                return exposure * BRIGHT / peak
            exposure *= 4.0 if peak < 1 else 1 / 16
        return 1.0

    def _codes(self, view: View, side: int, exposure: float) -> np.ndarray:
        """The frame's codes 0 to 255, as floats."""
        self.renderer.viewport_width, self.renderer.viewport_height = (count * side for count in view.resolution)
        frame, _ = self.renderer.render(self._stage(view, exposure))
        return frame[:, :, 0].astype(float)

    def _stage(self, view: View, exposure: float) -> Any:
        ambient = exposure * sum(light.radiance for light in self.scene.lights if isinstance(light, Environment))
        stage = self.pyrender.Scene(bg_color=np.zeros(4), ambient_light=np.full(3, ambient))
        for light in self.scene.lights:
            self._add(stage, light, exposure)
        stage.add(self._receiver(view.receiver.corners, view.receiver.reflectance))
        self._aim(stage, view)
        return stage

    def _add(self, stage: Any, light: Light, exposure: float) -> None:
        match light:
            case PointLight():
                bulb = self.pyrender.PointLight(color=np.ones(3), intensity=exposure * light.intensity)
                stage.add(bulb, pose=views.pose(light.position, *np.eye(3)))
            case DirectionalLight():
                beam = self.pyrender.DirectionalLight(color=np.ones(3), intensity=exposure * light.irradiance)
                t, b = geometry.tangents(light.direction)
                stage.add(beam, pose=views.pose(np.zeros(3), b, t, -geometry.unit(light.direction)))

    def _receiver(self, corners: np.ndarray, reflectance: float) -> Any:
        colour = [reflectance, reflectance, reflectance, 1.0]
        paint = self.pyrender.MetallicRoughnessMaterial(baseColorFactor=colour, metallicFactor=0.0, roughnessFactor=1.0)
        normal = geometry.unit(np.cross(corners[1] - corners[0], corners[3] - corners[0]))
        quad = self.pyrender.Primitive(positions=corners, normals=np.tile(normal, (4, 1)),
                                       indices=np.array([[0, 1, 2], [0, 2, 3]]), material=paint)
        return self.pyrender.Mesh([quad])

    def _aim(self, stage: Any, view: View) -> None:
        right, up, forward = geometry.camera_frame(view.origin, view.target, view.up)
        away = DISTANCE * float(max(view.half))
        camera = self.pyrender.OrthographicCamera(*view.half, znear=away / 2, zfar=2 * away)
        stage.add(camera, pose=views.pose(view.target - away * forward, right, up, -forward))


def _stretched(scene: Scene) -> str | None:
    """pyrender widens an orthographic view until its pixels are square."""
    square = all(view.has_square_pixels for view in views.views(scene))
    return None if square else "pyrender's pixels are square, and this film's cells are not"


def _linear(codes: np.ndarray) -> np.ndarray:
    """Radiance of codes, full scale 1."""
    return (codes / FULL) ** GAMMA
