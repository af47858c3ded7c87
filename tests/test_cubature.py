"""Cubature's bound: on every scene that it takes, the exact light lies within it; it shrinks as theory says; rules and heaps."""

from __future__ import annotations

import numpy as np
import pytest

from lightproof import suite
from lightproof.estimators.cubature import Cubature
from lightproof.scene import Scene

CATALOGUE = suite.default()


def opened(scene: Scene) -> Cubature | None:
    """None where it cannot."""
    made = Cubature("cubature", 2)
    if made.unsupported(scene):
        return None
    made.prepare(scene)
    return made


TAKEN = [scene for scene in CATALOGUE.scenes() if not Cubature("cubature", 1).unsupported(scene)]


def test_it_takes_flat_lights_and_says_why_it_takes_no_others():
    """Every direct scene of polygons and disks, behind blockers of any kind; neither bulbs, nor spheres that shine, nor skies."""
    taken = {scene.id for scene in TAKEN}
    assert {"square-light", "l-shaped-light", "disk-light", "two-lights", "occluded-square", "sphere-blocker"} <= taken
    assert {"disk-blocker", "picket-fence", "knife-edge", "umbra", "flux-closure"} <= taken
    for name in ("point-light", "sphere-light", "white-furnace-plane", "cube-room", "soft-shadow-picture"):
        assert len(Cubature("cubature", 1).unsupported(CATALOGUE.scene(name))) > 20


@pytest.mark.parametrize("samples", [1, 60, 1000])
def test_the_exact_light_lies_within_the_bound(samples):
    """Every scene that it takes, from one point per element on."""
    assert len(TAKEN) > 80
    for scene in TAKEN:
        rendering, reference = opened(scene).render(samples, 0), CATALOGUE.reference(scene)
        error = np.abs(rendering.film - reference.value)
        assert np.isfinite(rendering.film).all() and (rendering.film >= 0).all()
        assert (error <= rendering.bound + reference.uncertainty).all(), (scene.id, scene.case)


@pytest.mark.parametrize("name", ["hard-aspect:long-1e3", "hard-distance:disk"])
def test_additions_do_not_add_up(name):
    """65,536 points of a lamp 2 km long, and of one 100,000 km away: what their sum rounds off is less than the bound."""
    scene = CATALOGUE.scene(name)
    rendering, reference = opened(scene).render(65536, 0), CATALOGUE.reference(scene)
    assert (np.abs(rendering.film - reference.value) <= rendering.bound + reference.uncertainty).all()


@pytest.mark.parametrize(("name", "factor"), [("square-light", 0.03), ("disk-light", 1e-3), ("occluded-square", 0.45)])
def test_the_bound_shrinks(name, factor):
    """16 times the points: by N^-1/3 where an element sees a shadow's edge, far faster where it sees none."""
    made = opened(CATALOGUE.scene(name))
    few, many = (made.render(samples, 0) for samples in (256, 4096))
    assert many.bound.max() < factor * few.bound.max()
    assert abs(many.samples / 4096 - 1) < 0.1


def test_a_bound_is_worth_having():
    """square-light from afar: proven to 12 digits by 500 points; points in a lamp's plane, and an umbra: to be dark."""
    far = next(scene for scene in TAKEN if (scene.id, scene.case) == ("square-light", "far"))
    rendering = opened(far).render(500, 0)
    assert (rendering.bound < 1e-12 * rendering.film).all()
    for scene in (CATALOGUE.scene("hard-in-plane"), CATALOGUE.scene("umbra")):
        rendering = opened(scene).render(4000, 0)
        dark = rendering.bound == 0
        assert dark.any() and (rendering.film[dark] == 0).all()
