"""Named configurations: each gives the right answer, and each is set as it says."""

from __future__ import annotations

import numpy as np
import pytest

from lightproof import suite
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
