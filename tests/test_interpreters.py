"""A worker under another Python interpreter, so that two versions of a renderer stand side by side."""

from __future__ import annotations

import re
import sys
import sysconfig
import venv
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest

from lightproof import suite
from lightproof.checked import SceneError
from lightproof.cli import selection
from lightproof.renderers.pool import Pool
from lightproof.renderers.registry import METHODS, Entry
from lightproof.trial import Result, Status, Trial

SCENE = suite.default().scene("point-light")
TARGET = f"{Path(__file__).with_name('elsewhere.py')}:Elsewhere"


@pytest.fixture(scope="module")
def other(tmp_path_factory) -> Path:
    """An interpreter of its own that holds numpy and OpenEXR and nothing else, not even lightproof."""
    folder = tmp_path_factory.mktemp("other")
    venv.create(folder, symlinks=True)
    packages = Path(sysconfig.get_path("purelib", vars={"base": str(folder)}))
    for package in ("numpy", "OpenEXR"):
        for name in {file.parts[0] for file in metadata.files(package)} - {"..", "__pycache__"}:
            (packages / name).symlink_to(metadata.distribution(package).locate_file(name))
    return folder / "bin" / "python"


def render(python: Path | str, folder: Path) -> Result:
    entry = Entry("elsewhere", TARGET, worker=f"elsewhere {python}", python=str(python))
    trial = Trial(SCENE.id, SCENE.case, SCENE.digest, entry.name, samples=1, replicate=0)
    with Pool(threads=1) as pool:
        return pool.render(entry, SCENE, trial, folder / "film.exr", timeout=20)


def test_the_same_film_from_another_interpreter(other, tmp_path):
    """The worker runs where it was told to, by its prefix, and its film is that of our own interpreter to the last bit."""
    here, there = render("", tmp_path), render(other, tmp_path)
    assert (here.message, there.message) == ("", "")
    assert (here.version, there.version) == (sys.prefix, str(other.parents[1]))
    assert np.array_equal(here.film, there.film)


@pytest.mark.parametrize(("path", "complaint"), [
    ("no/such/python", "cannot be run (No such file or directory); give the path of a Python interpreter"),
    ("not-executable", "cannot be run (Permission denied); give the path of a Python interpreter"),
    ("bare/bin/python", "lacks numpy or OpenEXR: "),
])
def test_a_wrong_interpreter_says_what_would_be_right(path, complaint, tmp_path):
    """A path that leads nowhere, to a file that is no program, and to an interpreter without numpy."""
    (tmp_path / "not-executable").touch()
    venv.create(tmp_path / "bare", symlinks=True)
    result = render(tmp_path / path, tmp_path)
    assert result.status is Status.ERROR
    assert f"{tmp_path / path} {complaint}" in result.message


def manifest(folder: Path, method: str, python: Path | str) -> str:
    path = folder / "other.toml"
    path.write_text(f'name = "other-version"\nmethod = "{method}"\npython = "{python}"\n')
    return str(path)


def test_a_manifest_names_the_interpreter(other, tmp_path):
    """A configuration keeps its option, and nothing else of the registry's entry changes but where it runs. A path counts from
    the manifest's folder and is not followed, since a virtual environment is where its link is."""
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "python").symlink_to(other)
    (entry,) = selection.methods([manifest(tmp_path, "mitsuba/independent", "bin/python")], [])
    assert (entry.name, entry.target) == ("other-version/independent", METHODS["mitsuba/independent"].target)
    assert (entry.python, entry.nightly) == (str(tmp_path / "bin" / "python"), False)
    assert entry.worker != METHODS["mitsuba/independent"].worker


@pytest.mark.parametrize(("method", "python", "complaint"), [
    ("mitsuba", "no/python", "other.toml: python: there is no executable 'no/python'; give the path of a Python"),
    ("mitsuba", "no-such-python", "other.toml: python: there is no executable 'no-such-python'"),
    ("mitsubishi", sys.executable, "other.toml: method: there is no method 'mitsubishi'; did you mean mitsuba?"),
])
def test_a_wrong_manifest_says_where(method, python, complaint, tmp_path):
    with pytest.raises(SceneError, match=re.escape(complaint)):
        selection.methods([manifest(tmp_path, method, python)], [])
