"""Compiled kernels: that they take vector registers; where their cache is, that it notices every edit and is found again."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from itertools import product
from pathlib import Path

import numba
import numpy as np
import pytest
from numba import njit
from numba.core.codegen import get_host_cpu_features
from test_estimators import method

from lightproof import suite
from lightproof.estimators import compiled, pieces

PROGRAM = """
from numba.core import event
compiled = []
class Listener(event.Listener):
    def on_start(self, event): compiled.append(event.data["dispatcher"].py_func.__name__)
    def on_end(self, event): pass
event.register("numba:compile", Listener())
from estimators.kernel import irradiance
print(irradiance(2.0), "irradiance" in compiled)
"""
HELPER = "from estimators.compiled import strict\n\n\n@strict\ndef scaled(x):\n    return {factor} * x\n"
KERNEL = """from estimators.compiled import strict_kernel
from estimators.helper import scaled


@strict_kernel
def irradiance(x):
    return scaled(x)
"""


def test_digest_changes_with_any_source(tmp_path):
    """An edit, a new file, or a file renamed changes the digest; a second look does not."""
    folder = tmp_path / "estimators"
    shutil.copytree(compiled.SOURCES, folder, ignore=shutil.ignore_patterns("__pycache__"))
    seen = [compiled.digest(folder)]
    assert seen[0] == compiled.digest(compiled.SOURCES)
    (folder / "vectors.py").write_text((folder / "vectors.py").read_text() + "\n# edited\n")
    seen.append(compiled.digest(folder))
    (folder / "new.py").write_text("")
    seen.append(compiled.digest(folder))
    (folder / "new.py").rename(folder / "newer.py")
    seen.append(compiled.digest(folder))
    assert len(set(seen)) == 4


def test_the_widest_registers_are_used():
    """Where a processor has 512 bits, loops take them; it is asked of no other."""
    assert compiled.wide("+avx2,+avx512f,+fma") == "+avx2,+avx512f,+fma,-prefer-256-bit"
    assert [compiled.wide(features) for features in ("", "+avx2,-avx512f", "+neon")] == ["", "+avx2,-avx512f", "+neon"]

    @compiled.fast
    def total(values):
        found = np.float32(0)
        for value in values:
            found += value * value
        return found

    total(np.ones(100, np.float32))
    assembly = next(iter(total.inspect_asm().values()))
    assert ("zmm" in assembly) == ("+avx512f" in get_host_cpu_features().split(","))


@pytest.mark.parametrize(("name", "scene"), [
    *product(("mc-area", "mc-area/jitter", "mc-cosine/jitter", "mc-hemisphere/jitter", "riemann-area", "riemann-hemisphere"),
             ("sphere-light",)),
    *product(("mc-area/sobol", "mc-cosine/lattice", "mc-solid-angle", "mc-mis/jitter"), ("occluded-square",)),
])  # fmt: skip
def test_kernels_run_in_vector_registers(name, scene, monkeypatch):
    """Partial sums side by side, which a call in the loop prevents."""
    kernel = njit(nogil=True, fastmath=compiled.FAST, error_model="numpy")(pieces.estimate.py_func)
    monkeypatch.setattr(pieces, "estimate", kernel)
    method(name, suite.default().scene(scene))
    code = next(iter(kernel.inspect_llvm().values()))
    assert re.search(r"= phi .*<(4|8|16) x float>", code)


def test_folder_respects_the_user_s_cache(tmp_path, monkeypatch):
    """$XDG_CACHE_HOME/lightproof/kernels-<digest>, made on the spot; none where nothing can be written."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    folder = compiled.cache_folder()
    assert folder.parent == tmp_path / "lightproof" and folder.is_dir()
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert compiled.cache_folder() is None


def test_second_process_finds_the_kernel_and_an_edited_helper_is_noticed(tmp_path):
    """A kernel whose helper, in another file, multiplies by 3: compiled once, loaded the second time; with the helper edited
    to 5 compiled again, and the answer is the new one."""
    package = tmp_path / "estimators"
    package.mkdir()
    shutil.copy(compiled.__file__, package / "compiled.py")
    (package / "__init__.py").touch()
    (package / "kernel.py").write_text(KERNEL)
    (package / "helper.py").write_text(HELPER.format(factor="3.0"))
    assert [answer(tmp_path), answer(tmp_path)] == ["6.0 True", "6.0 False"]
    (package / "helper.py").write_text(HELPER.format(factor="5.0"))
    assert answer(tmp_path) == "10.0 True"


def answer(folder: Path) -> str:
    """What a fresh process prints: the kernel's value, and whether it compiled the kernel."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "cache")}
    command = [sys.executable, "-c", PROGRAM]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=True).stdout.strip()


def test_numba_s_own_setting_is_left_alone():
    """Other people's kernels in the same process keep their cache folder."""
    assert str(compiled.CACHE) != numba.config.CACHE_DIR
