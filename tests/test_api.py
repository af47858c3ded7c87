"""The calls for a notebook."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import lightproof
from lightproof import suite
from lightproof.api import RenderError


@pytest.fixture(scope="module")
def exact():
    return lightproof.reference("square-light").value.reshape(12, 16)


def test_load_and_reference_by_name_case_and_path():
    scene = lightproof.load("square-light:far")
    assert scene.case == "far"
    assert lightproof.reference(scene).value.max() < lightproof.reference("square-light").value.max()


def test_a_single_right_film_passes_and_a_wrong_one_is_undecided(exact):
    """One film cannot fail: that needs a second step. An error of 2 % of the largest value is four tolerances."""
    assert lightproof.judge(exact, "square-light").outcome == "pass"
    assert lightproof.judge(exact + 0.02 * exact.max(), "square-light").outcome == "undecided"


def test_replicates_are_judged_by_their_scatter(exact):
    random = np.random.default_rng(1)
    films = exact + random.normal(0, 1e-3 * exact.max(), (16, *exact.shape))
    assert lightproof.judge(films, "square-light").outcome == "pass"


def test_a_ladder_confirms_a_fail_and_names_the_mistake(exact):
    """Radiosity taken for radiance: pi times too bright at two steps, and that is what the reason says."""
    random = np.random.default_rng(2)
    ladder = {samples: np.pi * exact + random.normal(0, 0.01 / np.sqrt(samples), (16, *exact.shape)) for samples in (64, 256)}
    verdict = lightproof.judge(ladder, "square-light")
    assert verdict.outcome == "fail" and "pi" in verdict.reason


def test_a_loaded_scene_of_ones_own_finds_its_reference(tmp_path, exact):
    """A suite of the user's: the scene object alone is enough to know its light."""
    for name in ("scenes", "references"):
        shutil.copytree(suite.default().root / name, tmp_path / name)
    (tmp_path / "scenes" / "square-light.toml").rename(tmp_path / "scenes" / "mine.toml")
    for kind in ("csv", "toml"):
        (tmp_path / "references" / f"square-light.{kind}").rename(tmp_path / "references" / f"mine.{kind}")
    mine = lightproof.load(f"{tmp_path}/scenes/mine.toml")
    assert lightproof.judge(exact, mine).outcome == "pass"


def test_films_without_a_ladder_are_asked_for_no_samples(exact):
    verdict = lightproof.judge(exact + np.random.default_rng(3).normal(0, 0.1, (4, *exact.shape)), "square-light")
    assert verdict.outcome == "undecided" and verdict.samples_needed is None and "samples" not in verdict.reason


def test_films_of_the_wrong_shape_are_refused(exact):
    with pytest.raises(ValueError, match=r"\(12, 16\)"):
        lightproof.judge(exact.T, "square-light")
    with pytest.raises(ValueError, match=r"\(12, 16\)"):
        lightproof.judge(exact.ravel(), "square-light")


def test_render_one_film_and_replicates(exact):
    one = lightproof.render("square-light", "mc-area", samples=4096, threads=1)
    several = lightproof.render("square-light", "mc-area", samples=4096, replicates=2, threads=1)
    assert one.shape == (12, 16) and several.shape == (2, 12, 16)
    np.testing.assert_allclose(one, several[0], rtol=1e-6)  # a kernel just compiled and one from the cache may round differently
    assert (several[0] != several[1]).any()
    np.testing.assert_allclose(one, exact, atol=0.02 * exact.max())


@pytest.mark.parametrize("method", ["mine.py:render", "mine.toml"])
def test_render_takes_methods_of_the_users_own(method, tmp_path):
    """What the command line takes: a function in a file, which gives every cell 0.7, and the manifest of a program."""
    (tmp_path / "mine.py").write_text("def render(scene, samples, seed):\n    return [0.7] * scene.size\n")
    program = Path(__file__).with_name("outside_renderer.py")
    asked = [f'["python3", "{program}", {words}]' for words in ('"once", "none"', '"--version"')]
    (tmp_path / "mine.toml").write_text('name = "mine"\ncommand = {}\nversion = {}\n'.format(*asked))
    film = lightproof.render("point-light", str(tmp_path / method), samples=64, threads=1)
    assert film.shape == (12, 16) and (film > 0).all()
    if method == "mine.py:render":
        assert (film == 0.7).all()


def test_render_says_what_a_method_cannot_do():
    with pytest.raises(RenderError, match="pyrender has no area lights"):
        lightproof.render("square-light", "pyrender")
    with pytest.raises(ValueError, match="mc-area"):
        lightproof.render("square-light", "magic")
    with pytest.raises(ValueError, match=r"names \d+ methods"):
        lightproof.render("square-light", "mitsuba*")


def test_importing_the_package_loads_neither_reference_nor_judge():
    """A worker imports the package; the judge and the judged share nothing but the scene."""
    code = "import sys, lightproof.renderers.worker; print([m for m in sys.modules if m.startswith('lightproof')])"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    for module in ("references", "suite", "verdict", "certify", "api", "judging"):
        assert f"'lightproof.{module}" not in loaded
