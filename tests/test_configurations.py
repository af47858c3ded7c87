"""Named configurations: each gives the right answer, and each is set as it says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lightproof import suite
from lightproof.renderers import cycles, mitsuba_configurations, tessellation
from lightproof.renderers.cycles import Cycles
from lightproof.renderers.mitsuba import Mitsuba
from lightproof.renderers.pool import Pool
from lightproof.renderers.registry import METHODS
from lightproof.trial import Result, Status, Trial

SAMPLES = 256
SCENE = suite.default().scene("square-light")
EXACT = suite.default().reference(SCENE).value

MITSUBA = {
    "mitsuba": {"variant": "llvm_ad_mono", "sampler": "multijitter"},
    "mitsuba/independent": {"sampler": "independent"},
    "mitsuba/stratified": {"sampler": "stratified"},
    "mitsuba/orthogonal": {"sampler": "orthogonal"},
    "mitsuba/sobol": {"sampler": "ldsampler"},
    "mitsuba/emitter-sampling": {"integrator": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}},
    "mitsuba/mis": {"integrator": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 1}},
    "mitsuba/path": {"integrator": {"type": "path", "max_depth": 2, "rr_depth": 3}},
    "mitsuba/scalar": {"variant": "scalar_rgb"},
    "mitsuba/spectral": {"variant": "llvm_ad_spectral", "film": "specfilm"},
}
CYCLES = {
    "cycles": {"sampling_pattern": "TABULATED_SOBOL", "light_tree": False, "emitters": "lamps"},
    "cycles/lamp": {"emitters": "lamps"},
    "cycles/mesh": {"emitters": "meshes"},
    "cycles/light-tree": {"light_tree": True},
    "cycles/blue-noise": {"sampling_pattern": "BLUE_NOISE"},
    "cycles/automatic": {"sampling_pattern": "AUTOMATIC"},
}
CONFIGURATIONS = MITSUBA | CYCLES


@pytest.fixture(scope="module")
def pool():
    with Pool(threads=2) as pool:
        yield pool


def render(pool: Pool, name: str, folder, scene=SCENE, samples: int = SAMPLES) -> Result:
    entry = METHODS[name]
    trial = Trial(scene.id, scene.case, scene.digest, name, samples, replicate=0)
    result = pool.render(entry, scene, trial, folder / "film.exr", timeout=60)
    if "pip install" in result.message:
        pytest.skip(result.message)
    return result


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_light_of_a_square(pool: Pool, name: str, tmp_path):
    """square-light at 256 samples: the mean within 0.5 per cent, the elements together within 5 per cent of the largest, by the
    settings that the name stands for."""
    result = render(pool, name, tmp_path)
    assert (result.status, result.message) == (Status.OK, "")
    assert {key: result.settings[key] for key in CONFIGURATIONS[name]} == CONFIGURATIONS[name]
    assert result.film.mean() == pytest.approx(EXACT.mean(), rel=0.005)
    assert np.sqrt(np.mean((result.film - EXACT) ** 2)) < 0.05 * EXACT.max()


@pytest.mark.parametrize("name", ["mitsuba/spectral", "cycles/mesh"])
@pytest.mark.parametrize("scene", ["point-light", "beam", "white-furnace-plane", "square-light-seen", "disk-light"])
def test_every_kind_of_light(pool: Pool, name: str, scene: str, tmp_path):
    """A point, a beam, a sky, a lamp that is seen and one that is round, by configurations that take lights in a way of their
    own: the film's mean within one per cent, which any wrong unit costs many times over."""
    scene = suite.default().scene(scene)
    result = render(pool, name, tmp_path, scene)
    assert result.film.mean() == pytest.approx(suite.default().reference(scene).value.mean(), rel=0.01)


@pytest.mark.parametrize(("adapter", "known"), [
    (Mitsuba, "scalar, spectral, independent, stratified, orthogonal, sobol, emitter-sampling, mis, path"),
    (Cycles, "lamp, mesh, light-tree, blue-noise, automatic"),
])
def test_unknown_configurations_list_the_known_ones(adapter, known):
    """A name behind the / that no configuration has."""
    with pytest.raises(ValueError, match=f"renderer has no configuration 'fast'; there are {known}, and renderer alone"):
        adapter("renderer/fast", threads=1)


@pytest.mark.parametrize("adapter", [mitsuba_configurations, cycles])
def test_every_configuration_is_a_method(adapter):
    """The registry has each by name, in a process of its own; all but the best are left to the night."""
    name = adapter.__name__.rpartition(".")[2].partition("_")[0]
    entries = {key: entry for key, entry in METHODS.items() if key.partition("/")[0] == name}
    assert {key.partition("/")[2] for key in entries} == set(adapter.CONFIGURATIONS)
    assert [key for key, entry in entries.items() if not entry.nightly] == [name]
    assert len({entry.worker for entry in entries.values()}) == len(entries)


@pytest.mark.parametrize(("name", "scene", "reason"), [
    ("mitsuba/emitter-sampling", "sphere-furnace", "follows reflections only by its path tracer, which samples directions too"),
    ("mitsuba/spectral", "white-furnace-plane:tilted", "spectral sky map has the colour of daylight, and no flat spectrum"),
    ("cycles/lamp", "triangle-light", "lamps are spheres, disks and rectangles, and 'lamp' is none"),
    ("cycles/lamp", "square-light-seen", "lamps are not seen from behind"),
    ("cycles/lamp", "square-light", None),
    ("cycles/mesh", "triangle-light", None),
])
def test_what_a_configuration_cannot_do(name, scene, reason):
    adapter = Mitsuba if name.startswith("mitsuba") else Cycles
    refusal = adapter(name, threads=1).unsupported(suite.default().scene(scene))
    assert refusal is None if reason is None else refusal.endswith(reason)


def test_lamps_that_block_nothing_are_told():
    """cycles/lamp warns where one of two lamps may hide the other, not under a lone lamp, nor where there is none."""
    (light,) = SCENE.lights
    pair = replace(SCENE, lights=(light, replace(light, id="second")))
    glowing = suite.default().scene("sphere-furnace:irradiance")
    lamp = Cycles("cycles/lamp", threads=1)
    assert lamp.caveat(pair).startswith("Cycles' lamps block no light")
    assert lamp.caveat(SCENE) == lamp.caveat(glowing) == Cycles("cycles/mesh", threads=1).caveat(pair) == ""


def test_what_triangles_change_comes_with_the_film(pool, tmp_path):
    """sphere-light by an emitting mesh: as computed from its triangles. By Blender's lamp and by Mitsuba's sphere: nothing."""
    scene = suite.default().scene("sphere-light")
    meshed = render(pool, "cycles/mesh", tmp_path, scene, samples=16)
    computed = tessellation.difference(scene, tessellation.meshes(scene))
    np.testing.assert_allclose(meshed.tessellation, computed, rtol=1e-6)
    for native in ("cycles", "mitsuba"):
        assert render(pool, native, tmp_path, scene, samples=16).tessellation is None
