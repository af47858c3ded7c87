"""Methods are free of bias on scenes of every kind that they take, and what is exactly dark stays dark.

A nightly run judges every method on every case of every scene; here each composition of domain, points and tracing meets a
lamp of each shape, a blocker that all but touches the floor, and a camera. Seeds are fixed.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from test_estimators_domains import CATALOGUE, films, unbiased

from lightproof.estimators.mc_area import McArea
from lightproof.scale import Scale

DIM = 0.02  # of the brightest tile
SAMPLES, REPLICATES = 2048, 16
GRAIN = 1 / (4 * SAMPLES)  # of a value: one sample of a tile of four elements, that Sobol points meet in one film of many
SCENES = ("contact-shadow", "disk-blocker", "sphere-light", "square-light-seen")
METHODS = (
    "mc-area", "mc-area/jitter", "mc-area/lattice", "mc-area/sobol", "mc-hemisphere", "mc-cosine/sobol", "mc-solid-angle/lattice",
    "mc-projected-solid-angle/sobol", "mc-mis/jitter", "path", "path/sobol", "path/no-next-event",
)  # fmt: skip


CELLS = [*product(METHODS, SCENES), ("path", "lit-floor-to-wall"), ("path/sobol", "lit-floor-to-wall")]


@pytest.mark.parametrize(("method", "scene"), CELLS)
def test_no_method_is_biased(method, scene):
    """The means of tiles and of the film within chance of the exact light, but for tiles so dim that few samples meet any; where
    none arrives, none in any film."""
    scene = CATALOGUE.scene(scene)
    scale = Scale.of(scene, CATALOGUE.reference(scene))
    exact = scale.pooled(scale.value)[: scale.tiles + 1]
    found = films(method, scene, SAMPLES, REPLICATES)
    assert (found[:, scale.value == 0] == 0).all()
    bright = np.flatnonzero(exact > DIM * exact.max())
    assert unbiased(scale.pooled(found)[:, bright], exact[bright], GRAIN)


@pytest.mark.parametrize(("method", "scene", "samples"), [
    ("riemann-area", "hard-approach:triangle", 2**22),  # one huge value among small ones, whose sum rounding left below zero
    ("riemann-area", "hard-touching-edge:corner", 2**24),
    ("mc-area", "hard-approach:sphere", 2**20),  # points 0.37 pm away, of which float32 cannot hold 1/r^4
    ("cubature", "hard-in-plane", 2**30),  # nothing to refine, however many points it may take
])  # fmt: skip
def test_films_are_light(method, scene, samples):
    """Finite and not below zero where float32 is at its end."""
    found = films(method, next(one for one in CATALOGUE.scenes() if one.name == scene), samples, 4)
    assert np.isfinite(found).all() and (found >= 0).all()


def test_variances_are_numbers():
    """The middle of a disk 0.37 pm away, which one sample in 16 million meets: its square is beyond float32."""
    scene = next(one for one in CATALOGUE.scenes() if one.name == "hard-approach:disk")
    method = McArea("mc-area", 2)
    method.prepare(scene)
    assert np.isfinite(method.render(2**22, 38).variance).all()
