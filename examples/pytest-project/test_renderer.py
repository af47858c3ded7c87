"""Is the light of this renderer right? Run `pytest` in this folder; Lightproof brings the fixture `lightproof`."""

from __future__ import annotations

import numpy as np
import pytest
from renderer import render

from lightproof import load


@pytest.mark.parametrize("scene", ["square-light", "occluded-square"])
def test_the_light_is_right(lightproof, scene):
    """The whole film and each of 64 parts of it are within half a per cent, proven by the scatter of 16 films."""
    lightproof.check(render, scene)


def too_dark(scene, samples, seed):
    return render(scene, samples, seed) / np.pi


def test_a_forgotten_pi_is_noticed(lightproof):
    with pytest.raises(AssertionError, match="1/pi"):
        lightproof.check(too_dark, "square-light", samples=1024)


def test_what_the_renderer_cannot_do(lightproof):
    with pytest.raises(AssertionError, match=r"unsupported.*rectangles only"):
        lightproof.check(render, "disk-light")


def test_films_from_anywhere(lightproof):
    """Films are judged too, here 16 that differ in their noise alone."""
    scene = load("square-light")
    lightproof.check(np.array([render(scene, 1024, seed) for seed in range(16)]), scene)
