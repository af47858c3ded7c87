"""What the README says is true: every command and every example in it runs."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import lightproof
from lightproof import films

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", README, flags=re.MULTILINE | re.DOTALL)


def commands(program: str) -> list[str]:
    lines = [line.split("#")[0].strip() for block in blocks("sh") for line in block.splitlines()]
    return [line for line in lines if line.startswith(program + " ")]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder like the checkout, so that nothing is written into the checkout itself, a picture rendered by hand, and a renderer
    in C++ with the manifest that the README shows."""
    folder = tmp_path_factory.mktemp("readme")
    for name in ("scenes", "references"):
        shutil.copytree(ROOT / name, folder / name)
    (folder / "reports").mkdir()
    exact = lightproof.reference("square-light").value.reshape(lightproof.load("square-light").film.grid)
    films.write(folder / "square-light.exr", exact.shape, {"Y": exact[::-1] / np.pi}, {})
    (folder / "my-renderer.toml").write_text(next(block for block in blocks("toml") if "my-renderer" in block))
    if shutil.which("c++"):
        source = ROOT / "examples/area-light/area_light.cpp"
        subprocess.run(["c++", "-O2", "-std=c++17", "-o", folder / "my_renderer", source], check=True)
    return folder


def test_the_first_two_commands_are_the_ones_that_do_everything():
    assert commands("make")[:2] == ["make report", "make test"]
    for command in commands("make"):
        subprocess.run([*shlex.split(command), "--dry-run"], cwd=ROOT, check=True, capture_output=True)


@pytest.mark.parametrize("command", commands("lightproof"))
def test_commands_run_as_written(command, folder):
    """In the README's order: the page is that of the run before it."""
    if "my-renderer" in command and shutil.which("c++") is None:
        pytest.skip("there is no C++ compiler: apt-get install g++")
    run = subprocess.run([sys.executable, "-m", "lightproof.cli", *shlex.split(command)[1:]], cwd=folder,
                         capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr


def test_the_python_example_runs():
    example = next(block for block in blocks("python") if "lightproof.load" in block)
    run = subprocess.run([sys.executable, "-c", example], capture_output=True, text=True, check=True)
    assert run.stdout.startswith("pass")


def test_the_pytest_example_runs(tmp_path):
    example = next(block for block in blocks("python") if "lightproof_gate" in block)
    (tmp_path / "test_example.py").write_text(example)
    run = subprocess.run([sys.executable, "-m", "pytest", "-q", str(tmp_path)], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0 and "1 passed" in run.stdout, run.stdout


def test_links_and_pictures_lead_somewhere():
    for target in re.findall(r"\]\(([^)]+)\)|`([a-z-]+(?:/[A-Za-z0-9_.-]+)+)`", README):
        path = next(filter(None, target))
        if "<" not in path and path not in ("reports/runs", ".venv/bin/") and not path.startswith("references/<"):
            assert (ROOT / path).exists(), path
