"""Radiance, through its own programs oconv and rtrace.

Irradiance is what `rtrace -I` measures at points of the film, with nothing laid into it; radiance is what rtrace sees along
lines of sight. Radiance's numbers are radiances per channel; the first channel is taken and no luminous efficacy applied.
"""

from __future__ import annotations

import importlib.metadata
import math
import tempfile
import time
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from lightproof.method import Method, Rendering
from lightproof.renderers import importing, radiance_apertures, radiance_rays, radiance_scene, radiance_transport, scratch
from lightproof.renderers.radiance_process import Programs, Rtraces
from lightproof.renderers.radiance_transport import Transport
from lightproof.renderers.transport import FAINT
from lightproof.scene import CameraFilm, DirectionalLight, PointLight, PointsFilm, Scene, SunDisc

SHAPES, SCENE, OCTREE = "shapes.cal", "scene.rad", "scene.oct"
STRATA = 64  # parts of a lamp or of the hemisphere, each sampled once from each point
DROPPED = 1e-4  # times a lamp's parts: the cosine below which Radiance takes one for seen from behind
EXTENT = 3e3  # about how large a scene is made (a room in millimetres): what is closer than 1e-6 Radiance takes for one place
AT_ONCE = 1 << 18  # rays made at a time
EXACT = ["-dt", "0", "-dc", "1", "-dr", "0", "-dp", "0", "-st", "1", "-lw", str(FAINT)]
"""No shadow ray is left out, faint paths end by Russian roulette alone."""
CACHED = ["-aa", "0.1", "-ar", "64", "-ad", "512", "-lw", "1e-4"]
MOST_CACHED = 2  # times that the cache is made to look around: in a furnace each further one takes ten times as long

SEQUENCE, RANDOM = "-u-", "-u+"
PERIOD = 2048  # numbers of the sequence, one of them for each ray and light

CACHE, NATIVE, QUASI_RANDOM = "ambient-cache", "native-lamps", "quasi-random"
CAVEATS = {
    CACHE: "Radiance's ambient cache interpolates indirect light between points, which no number of samples makes exact.",
    NATIVE: "Radiance samples a lamp that is no parallelogram as a square of its area, a round one as a box inside it: light is"
            " off by several per cent however many samples.",
    QUASI_RANDOM: "Radiance's own order of random numbers is a fixed sequence of 2,048 that begins anew with each picture:"
                  " cells in penumbrae stay some thousandths of the brightest off, under half a sky some per cents.",
}
ABSOLUTE = ("Radiance takes for one place what is closer than about a billionth of the scene's size, and leaves out a lamp that"
            " it sees at a cosine below 1e-4.")


class Radiance(Method):
    """Radiance with every approximation off; by options as it is used: `radiance/quasi-random`."""

    def __init__(self, name: str, threads: int):
        super().__init__(name, threads)
        self.option = name.partition("/")[2]
        self.deterministic = self.option == QUASI_RANDOM
        self.rtraces: Rtraces | None = None

    def open(self) -> None:
        folder = Path(importing.renderer("pyradiance", "radiance").__file__).parent
        self.folder = tempfile.TemporaryDirectory(dir=scratch.in_memory())
        self.programs = Programs(folder, Path(self.folder.name))

    def version(self) -> str:
        radiance = self.programs.output("rtrace", "-version").decode().split()[1]
        return f"{radiance} (pyradiance {importlib.metadata.version('pyradiance')})"

    def settings(self) -> Mapping[str, Any]:
        return {"options": " ".join(self.options), "lamps": _lamps(self.planned),
                "strata": self.strata}

    def unsupported(self, scene: Scene) -> str | None:
        if scene.film.quantity == "solid_angle":
            return "Radiance gives no solid angles"
        reason = radiance_transport.unsupported(scene, self._plan(scene))
        return reason or (_uncached(scene, self._plan(scene)) if self.option == CACHE else None)

    def caveat(self, scene: Scene) -> str:
        even = all(radiance_transport.is_parallelogram(lamp.shape) for lamp in radiance_transport.lamps(scene))
        known = "" if self.option == NATIVE and even else CAVEATS.get(self.option, "")
        return known or (ABSOLUTE if scene.tolerance_scale == "element" else "")

    def prepare(self, scene: Scene) -> Mapping[str, float]:
        start = time.perf_counter()
        self.film, self.planned = scene.film, self._plan(scene)
        self.strata = 1 if self.option == CACHE else strata(scene, self.planned)
        self.options = [*options(scene, self.planned, self.strata, self.option == CACHE), self._sequence()]
        self.skips = self.options[-1] == SEQUENCE and not self.deterministic
        place = Path(self.folder.name)
        (place / SHAPES).write_text(radiance_scene.SHAPES)
        (place / SCENE).write_text(radiance_scene.describe(scene, self.planned, SHAPES))
        self.scale = 10.0 ** round(math.log10(EXTENT / radiance_apertures.whole(scene)[1]))
        scaled = self.programs.output("xform", "-s", repr(self.scale), place / SCENE)
        self.octree = place / OCTREE
        self.octree.write_bytes(self.programs.output("oconv", "-", given=scaled))
        self._start()
        return {"setup": time.perf_counter() - start}

    def render(self, samples: int, seed: int) -> Rendering:
        if self.deterministic or self.option == CACHE:
            self._start()
        points = math.ceil(samples / self.strata)
        passes = math.ceil(points * math.prod(self.film.grid) / AT_ONCE)
        each = math.prod(radiance_rays.strata(math.ceil(points / passes)))
        generator = np.random.default_rng(0 if self.deterministic else seed)
        film = np.mean([self._pass(each, generator) for _ in range(passes)], axis=0)
        return Rendering(film, samples=passes * each * self.strata)

    def _pass(self, count: int, generator: np.random.Generator) -> np.ndarray:
        skipped = partial(generator.integers, PERIOD) if self.skips else int
        values = self.rtraces.trace(radiance_rays.rays(self.film, count, generator, self.scale), skipped)
        return values.reshape(-1, count).mean(axis=1)

    def _plan(self, scene: Scene) -> Transport:
        return radiance_transport.transport_of(scene, self.option == NATIVE)

    def _sequence(self) -> str:
        """Radiance's own sequence of random numbers has less noise, and begun anywhere it is right on the mean over lamps; over
        the hemisphere it is not."""
        return SEQUENCE if self.deterministic or not self.planned.bounces else RANDOM

    def _start(self) -> None:
        """New processes, with empty caches and at the start of their sequences."""
        if self.rtraces:
            self.rtraces.close()
        self.rtraces = self.programs.rtraces(self.options, self.octree, self.threads)


def _uncached(scene: Scene, planned: Transport) -> str | None:
    """Why Radiance's ambient cache is nothing for a scene, or None."""
    if not (scene.reflects and planned.bounces):
        return "no light here is indirect, so that Radiance interpolates none"
    if planned.bounces > MOST_CACHED:
        return (f"light that counts here is found by looking around {planned.bounces} times, and Radiance's ambient cache takes"
                f" about ten times as long for each beyond {MOST_CACHED}")
    return None


def _lamps(planned: Transport) -> str:
    if planned.middle:
        return "one ray to the middle"
    return "native" if planned.native else "sampled evenly"


def strata(scene: Scene, planned: Transport) -> int:
    """Parts of each lamp, or of the hemisphere, that are sampled from one point. One where paths go on from there; and, because
    Radiance leaves out a part that it sees at a cosine below `DROPPED` times their number, where a lamp is seen as flatly as
    that, or where each element counts by itself; and where the lamp's middle says all."""
    if planned.middle:
        return 1
    lamps, suns = radiance_transport.lamps(scene), [light for light in scene.lights if isinstance(light, SunDisc)]
    if planned.bounces:
        small = any(isinstance(light, PointLight | DirectionalLight) for light in scene.lights)
        return STRATA if planned.bounces == 1 and not (planned.aims and (lamps or suns or small)) else 1
    looks = not isinstance(scene.film, CameraFilm) or scene.reflects
    each = isinstance(scene.film, PointsFilm) or scene.tolerance_scale == "element"
    flatly = any(radiance_apertures.flatly(lamp.shape, scene.film, STRATA * DROPPED) for lamp in lamps)
    return STRATA if (lamps or suns) and looks and not each and not flatly else 1


def options(scene: Scene, planned: Transport, parts: int, cache: bool) -> list[str]:
    """Of rtrace: as many bounces as count; a lamp or the hemisphere in `parts`; indirect light from a `cache` or not."""
    lamps = ["-ds", "0" if planned.bounces or parts == 1 else "1e-4", "-dj", "0" if planned.middle else "1"]
    around = ["-ab", str(planned.bounces), "-as", "0"]
    stored = CACHED if cache else ["-aa", "0", "-ad", str(parts if planned.bounces else 1)]
    depth = planned.bounces + 1  # a negative limit means roulette, in which the 512 rays of a cached value would never end
    irradiance = [] if isinstance(scene.film, CameraFilm) else ["-I+"]
    return [*EXACT, *lamps, *around, *stored, "-lr", str(depth if cache else -depth), *irradiance]
