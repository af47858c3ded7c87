"""A renderer in a few lines of Python, on the command line and in somebody else's tests."""

from __future__ import annotations

import importlib
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lightproof import api, store, suite
from lightproof.checking import check
from lightproof.cli import main
from lightproof.films import FilmError
from lightproof.method import Rendering
from lightproof.renderers.function import Function
from lightproof.scene import Scene

ROOT = Path(__file__).parents[1]
PROJECT = ROOT / "examples/pytest-project"
SCENE = suite.default().scene("point-light")


def readme(wanted: str) -> str:
    """The Python example of the README that holds some words."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return next(block for block in re.findall(r"(?ms)^```python\n(.*?)^```", text) if wanted in block)


def pytest_in(folder: Path) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


def test_the_example_project_passes():
    """Its renderer is right, its broken one is noticed, and films from anywhere are judged."""
    run = pytest_in(PROJECT)
    assert run.returncode == 0 and "5 passed" in run.stdout, run.stdout


def test_the_readme_s_renderer_and_test(tmp_path):
    """The few lines pass on the command line, and under pytest."""
    (tmp_path / "my_renderer.py").write_text(readme("def render(scene, samples, seed)"))
    (tmp_path / "test_light.py").write_text(readme("def test_light(lightproof)"))
    target = f"{tmp_path}/my_renderer.py:render"
    assert main(["run", "point-light", "--with", target, "--strict", "--out", str(tmp_path / "runs"), "--threads", "1"]) == 0
    version = store.latest(tmp_path / "runs").run.versions["my_renderer:render"]
    assert re.fullmatch("sha256 [0-9a-f]{12}", version)
    run = pytest_in(tmp_path)
    assert run.returncode == 0 and "1 passed" in run.stdout, run.stdout


def exact(scene: Scene, samples: int, seed: int) -> np.ndarray:
    """What the reference says, which no renderer knows."""
    return api.reference(scene.name).value.reshape(scene.film.grid)


def noisy(scene: Scene, samples: int, seed: int) -> Rendering:
    noise = np.random.default_rng(seed).normal(size=scene.film.grid)
    return Rendering(exact(scene, samples, seed) * (1 + 2 * noise / np.sqrt(samples)), samples)


def too_bright(scene: Scene, samples: int, seed: int) -> np.ndarray:
    return np.pi * exact(scene, samples, seed)


def forgets_the_seed(scene: Scene, samples: int) -> np.ndarray:
    return exact(scene, samples, 0)


def transposed(scene: Scene, samples: int, seed: int) -> np.ndarray:
    return exact(scene, samples, seed).T


def crashes(scene: Scene, samples: int, seed: int) -> None:
    import ctypes

    ctypes.string_at(0)


def stumbles(scene: Scene, samples: int, seed: int) -> None:
    raise ZeroDivisionError("no light at all")


def test_what_is_right_passes():
    """A function, a method of Lightproof's own, and films in each shape."""
    assert check(exact, "point-light").outcome == "pass"
    assert check("mc-area", "point-light").steps[0].replicates == 16
    reference = api.reference("point-light").value
    for film in (reference, reference.reshape(SCENE.film.grid), {64: reference.reshape(SCENE.film.grid)}):
        assert check(film, SCENE).outcome == "pass"


@pytest.mark.parametrize(("renderer", "message"), [
    (too_bright, r"test_plugin:too_bright on point-light: fail: .* is off by .*pi"),
    (noisy, r"undecided: .*; [\d,]+ samples would decide \(it had 300 s and at most 256 samples\)"),
    (forgets_the_seed, r"takes \(scene: .*\) -> .*, but is called with \(scene, samples, seed\): too many positional"),
    (transposed, r"the film has shape \(16, 12\); it must be an array of shape \(192,\), row by row, or \(12, 16\)"),
    (crashes, r"killed by SIGSEGV"),
    (stumbles, r"ZeroDivisionError: no light at all \(test_plugin\.py, line \d+\)"),
    ("riemann-hemisphere", r"riemann-hemisphere on point-light: unsupported: "),
    (np.zeros(SCENE.size), r"the film on point-light: undecided: no sample has reached the light"),
])  # fmt: skip
def test_what_is_not_right_says_why(renderer, message):
    """Too bright, too noisy, called wrongly, no film, not here: an assertion with the verdict's reason."""
    with pytest.raises(AssertionError, match=message):
        check(renderer, "point-light", samples=256)


@pytest.mark.parametrize(("judged", "options", "message"), [
    ("magic", {}, "there is no method 'magic'; there are analytic, "),
    (lambda scene, samples, seed: None, {}, "is not at the top level of a file"),
    ("mc-area", {"samples": 16}, "give at least 64"),
    (np.zeros(7), {}, r"do not fit point-light; give \(12, 16\)"),
])
def test_what_cannot_be_judged_is_no_verdict(judged, options, message):
    """A mistake in the test itself: a ValueError that says what would be right."""
    with pytest.raises(ValueError, match=message):
        check(judged, "point-light", **options)


@pytest.mark.parametrize(("film", "message"), [
    (None, r"the film is None: does the function return it\? It must be an array of shape \(192,\)"),
    ("light", "the film is 'light', which holds no numbers"),
    (np.ones((192, 1)), r"the film has shape \(192, 1\)"),
    (Rendering(np.ones(192), 64, variance=np.ones(3)), r"the variance has shape \(3,\)"),
])
def test_what_is_no_film_says_so(film, message):
    """Nothing returned, a word, a column, a variance of another film."""
    method = Function(lambda scene, samples, seed: film, "mine", threads=1)
    method.prepare(SCENE)
    with pytest.raises(FilmError, match=message):
        method.render(64, 1)


def test_what_a_function_says_of_its_noise_is_kept():
    """A Rendering with film and variance by rows: both flat."""

    def render(scene: Scene, samples: int, seed: int) -> Rendering:
        return Rendering(np.ones(scene.film.grid), samples + 1, variance=np.ones(scene.film.grid))

    method = Function(render, "mine", threads=1)
    method.open()
    method.prepare(SCENE)
    rendering = method.render(64, 1)
    assert rendering.film.shape == rendering.variance.shape == (SCENE.size,)
    assert rendering.samples == 65


def test_names_that_a_terminal_would_obey_are_shown_as_text(tmp_path, capsys):
    """A file whose name and whose version clear the screen and paint it red: shown, and recorded, without the escapes."""
    hostile = tmp_path / "\x1b[2Jmine.py"
    hostile.write_text('__version__ = "\\x1b[31m[red]1.0"\ndef render(scene, samples, seed): ...\n')
    assert main(["run", "point-light", "--with", f"{hostile}:render", "--out", str(tmp_path / "runs"), "--threads", "1"]) == 3
    assert main(["doctor", f"{hostile}:render"]) == 3
    printed = capsys.readouterr()
    assert "\x1b" not in printed.out + printed.err
    assert store.latest(tmp_path / "runs").run.versions["[2Jmine:render"] == "[31m[red]1.0"


def test_a_renderer_of_several_files(tmp_path, monkeypatch):
    """A file that defines a dataclass and imports the file beside it, and one in a package that imports from the package."""
    (tmp_path / "brightness.py").write_text("FACTOR = 1.0\n")
    (tmp_path / "shiny.py").write_text("""from __future__ import annotations
from dataclasses import dataclass
import brightness
from test_plugin import exact

@dataclass
class Settings:
    factor: float = brightness.FACTOR

def render(scene, samples, seed):
    return Settings().factor * exact(scene, samples, seed)
""")
    (tmp_path / "package").mkdir()
    (tmp_path / "package/__init__.py").touch()
    (tmp_path / "package/inner.py").write_text("from . import shiny\n\ndef render(*job):\n    return shiny.render(*job)\n")
    (tmp_path / "package/shiny.py").write_text("from shiny import render\n")
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("shiny", "package.inner"):
        assert check(importlib.import_module(name).render, "point-light").outcome == "pass"


def test_two_files_of_one_name_are_told_apart(tmp_path, capsys):
    """a/mine.py and b/mine.py: refused, rather than one of them run alone."""
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "mine.py").write_text("def render(scene, samples, seed): ...\n")
    targets = [f"{tmp_path}/{folder}/mine.py:render" for folder in ("a", "b")]
    assert main(["run", "point-light", "--with", *targets, "--out", str(tmp_path)]) == 2
    assert "two different methods are called mine:render" in capsys.readouterr().err
