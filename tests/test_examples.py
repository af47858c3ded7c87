"""The examples are what they claim to be: complete renderers that the conformance test passes. And it fails those that err."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from lightproof import suite
from lightproof.cli import main, selection
from lightproof.renderers.pool import Pool
from lightproof.trial import Trial

EXAMPLES = Path(__file__).parents[1] / "examples"
RENDERER = Path(__file__).with_name("outside_renderer.py")
SUITE = suite.default()


def doctor(manifest: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """Exit status and lines of `lightproof doctor`."""
    status = main(["doctor", str(manifest)])
    return status, capsys.readouterr().out


@pytest.fixture(scope="module")
def area_light(tmp_path_factory) -> Path:
    """The manifest of the C++ example, built as its first line says."""
    if shutil.which("c++") is None:
        pytest.skip("there is no C++ compiler: apt-get install g++")
    folder = tmp_path_factory.mktemp("area-light")
    shutil.copytree(EXAMPLES / "area-light", folder, dirs_exist_ok=True)
    (command,) = re.findall(r"c\+\+ -O2 .*$", (folder / "area_light.cpp").read_text(), re.MULTILINE)
    subprocess.run([*command.split(), "-Wall", "-Wextra", "-Werror"], cwd=folder, check=True, timeout=120)
    return folder / "area-light.toml"


def test_the_renderer_in_cpp_passes(area_light, capsys):
    """Every check of the conformance test, and a word on each."""
    status, out = doctor(area_light, capsys)
    assert (status, out.count("  pass  ")) == (0, 8), out
    assert "declines: solid-angle-rectangle: area-light gives irradiance, over a plane or at points" in out
    assert "units, square-light: mean 0.60" in out


SHADOWS = ["occluded-square", "two-lights:one-before-the-other", "l-shaped-blocker", "square-light:tilted"]


@pytest.mark.parametrize("name", SHADOWS)
def test_the_renderer_in_cpp_is_right(area_light, tmp_path, name):
    """Shadows, two lamps of which one hides the other, a concave blocker, a leaning plane: the film is the exact light but for
    noise, as large as the renderer says it is."""
    (entry,) = selection.methods([str(area_light)], [])
    scene = SUITE.scene(name)
    with Pool(threads=1) as pool:
        trial = Trial(scene.id, scene.case, scene.digest, entry.name, 4096, 0)
        result = pool.render(entry, scene, trial, tmp_path / "film.exr", 60)
    exact = SUITE.reference(scene).value
    lit = result.variance > 0
    assert np.array_equal(result.film[~lit], exact[~lit])
    deviations = (result.film[lit] - exact[lit]) / np.sqrt(result.variance[lit])
    assert 0.8 < deviations.std() < 1.25
    assert abs(deviations.sum()) < 4 * np.sqrt(lit.sum())


def test_the_shell_script_passes(capsys, monkeypatch):
    """Radiance's rtrace, as pyradiance brings it, behind a shell script."""
    if shutil.which("jq") is None:
        pytest.skip("there is no jq: apt-get install jq")
    if importlib.util.find_spec("pyradiance") is None:
        pytest.skip("there is no rtrace: pip install 'lightproof[radiance]'")
    binaries = Path(importlib.util.find_spec("pyradiance").origin).parent / "bin"
    monkeypatch.setenv("PATH", f"{binaries}{os.pathsep}{os.environ['PATH']}")
    status, out = doctor(EXAMPLES / "rtrace/rtrace.toml", capsys)
    assert (status, out.count("  pass  ")) == (0, 7), out
    assert "version: RADIANCE" in out


def test_the_smallest_renderer_on_the_page_passes(tmp_path, capsys):
    """The Python program and the manifest at the end of examples/README.md, copied out as they stand."""
    page = (EXAMPLES / "README.md").read_text().partition("## The smallest renderer")[2]
    for language, name in (("python", "smallest.py"), ("toml", "smallest.toml")):
        (text,) = re.findall(rf"```{language}\n(.*?)```", page, re.DOTALL)
        (tmp_path / name).write_text(text)
    status, out = doctor(tmp_path / "smallest.toml", capsys)
    assert (status, out.count("  pass  ")) == (0, 7), out
    assert "renders: point-light" in out


@pytest.mark.parametrize(("fault", "line"), [
    ("pi", "units, point-light: 3.14 times too bright: is the division by pi missing?"),
    ("ignores-seed", "other seed: the same film: is the seed ignored?"),
    ("ignores-samples", "of the variance, not 0.25: are the samples ignored?"),
    ("undivided-variance", "times that of its films: is it that of one sample, not divided by their number?"),
    ("declines-nothing", "units, square-light: black: does any light reach the film?"),
])  # fmt: skip
def test_the_doctor_says_what_is_wrong(tmp_path, capsys, fault, line):
    """A renderer with one mistake: exit 3, and the mistake by its name on a line that says FAIL."""
    status, out = doctor(_described(tmp_path, fault), capsys)
    assert status == 3
    assert line in "\n".join(each for each in out.splitlines() if "FAIL" in each), out


def test_the_doctor_of_a_renderer_without_chance(tmp_path, capsys):
    """A manifest that says deterministic: the same film for every seed is right then, and there is no variance to try."""
    status, out = doctor(_described(tmp_path, "ignores-seed", "deterministic = true"), capsys)
    assert (status, "samples:" in out) == (0, False), out
    assert "other seed: same film, as deterministic in its manifest has it" in out


def test_the_doctor_asks_for_what_the_manifest_excludes(tmp_path, capsys):
    """A program that leaves it to its manifest to decline, and renders whatever it is asked for: told so."""
    status, out = doctor(_described(tmp_path, "declines-nothing", '[supports]\nlights = ["point"]\n'), capsys)
    assert status == 3
    assert "FAIL  declines: asked for square-light, which it does not support" in out
    assert 'it rendered it; it must answer "unsupported", with the reason' in out


def test_the_doctor_of_what_does_not_start(tmp_path, capsys):
    """A program that has not been built: one line, exit 3."""
    shutil.copy(EXAMPLES / "area-light/area-light.toml", tmp_path)
    status, out = doctor(tmp_path / "area-light.toml", capsys)
    assert (status, out.count("\n")) == (3, 2)
    assert f"FAIL  version: there is no executable ./area_light in {tmp_path}: build it there" in out


def test_the_doctor_repeats_what_a_program_says_as_it_fails(tmp_path, capsys):
    """A program that cannot find what it needs: its own words."""
    complain = '["sh", "-c", "echo rtrace: not found >&2; exit 127"]'
    (tmp_path / "lost.toml").write_text(f'name = "lost"\ncommand = {complain}\nversion = {complain}\n')
    status, out = doctor(tmp_path / "lost.toml", capsys)
    assert status == 3
    assert "it exited with status 127 before it answered; it last wrote: rtrace: not found" in out


def _described(folder: Path, fault: str, more: str = "") -> Path:
    words = ["python3", str(RENDERER)]
    commands = f"command = {[*words, 'lasting', fault]}\nversion = {[*words, '--version']}"
    path = folder / "wrong.toml"
    path.write_text(f'name = "wrong"\nmode = "lasting"\n{commands}\n{more}')
    return path
