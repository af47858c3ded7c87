"""Whatever a renderer does wrong costs its own trial: the fault is recorded in words, and the rest is unharmed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import psutil
import pytest
from test_process import FILE_LIMIT, SCENE, entry, light, trial

from lightproof.renderers import manifest
from lightproof.renderers.pool import Pool
from lightproof.trial import Result, Status

NO_LIGHT = "every value must be finite and zero or more"
TOO_LARGE = "OSError: [Errno 27] File too large: no file and no output may have more than 1,048,576 bytes"

# What is wrong -> what the record says, while starting, preparing or rendering. Crashes (TRIED_AGAIN) are tried once more.
FAULTS = {
    "exits-at-once": "while starting the renderer: its process exited with status 7 before it answered; it wrote nothing",
    "raises-while-preparing": "while preparing the scene: RuntimeError: the scene is too beautiful (misbehaving.py, line ",
    "raises": "while rendering: RuntimeError: out of photons [2J(really) (misbehaving.py, line ",
    "exits-mid-job": "its process exited with status 9 before it answered; it last wrote: the licence has expired",
    "calls-exit": "while rendering: its process exited with status 5 before it answered",
    "segfaults": "its process was killed by SIGSEGV before it answered; it wrote nothing (at the second attempt too)",
    "killed": "its process was killed by SIGKILL (out of memory?) before it answered; it last wrote: the end is near",
    "dies-of-an-odd-signal": "its process was killed by signal 35 before it answered",
    "floods": TOO_LARGE,
    "fills-the-disk": TOO_LARGE,
    "speaks-nonsense": "while rendering: it wrote b'100% done' into the harness's pipe, which is no answer",
    "drones-on": "while rendering: it wrote b'light light light light light light ligh' and so on into the harness's pipe",
    "closes-pipe": "while rendering: its process closed the harness's pipe",
    "writes-nothing": "there is no such file",
    "writes-half-an-image": "it may be truncated",
    "writes-another-size": "has (1, 2) rows and columns; it must have (12, 16)",
    "writes-another-scene": "the film's header names another scene (digest [2J0123); it must be ",
    "nan": f"1 of 192 values of Y are no light, the first nan in element 3; {NO_LIGHT}",
    "infinite": f"1 of 192 values of Y are no light, the first inf in element 4; {NO_LIGHT}",
    "negative": f"1 of 192 values of Y are no light, the first -1 in element 5; {NO_LIGHT}",
    "misshapen": "the film's Y has shape (191,); it must be (192,), row by row",
    "counts-backwards": "the film has -64 samples; it must be those spent per element, 1 or more",
    "two-dimensional": "the film's Y has shape (12, 16); it must be (192,), row by row",
}
TRIED_AGAIN = ("exits-mid-job", "calls-exit", "segfaults", "killed", "dies-of-an-odd-signal", "speaks-nonsense", "drones-on",
               "closes-pipe")
TIME_OUTS = {
    "hangs": "while rendering: no answer within 0.5 s; it last wrote: thinking about it",
    "hangs-after": "while rendering: no answer within 0.5 s; it last wrote: thinking about it",
    "ignores-sigterm": "while rendering: no answer within 0.5 s; it last wrote: thinking about it",
    "stops": "while rendering: no answer within 0.5 s; it last wrote: the end is near",
}
OUTSIDE = {  # beside the faults of tests/test_protocol.py
    "exits-at-once": ("lasting", "it exited with status 1 before it answered; it last wrote: no licence"),
    "is-killed": ("once", "it was killed by SIGKILL (out of memory?) before it answered; it last wrote: more memory"),
    "fills-the-disk": ("once", "it exited with status 1 before it answered; it last wrote: "),
    "infinite": ("lasting", f"1 of 192 values of Y are no light, the first inf in element 0; {NO_LIGHT}"),
    "too-short": ("lasting", "its film has 191 values; this film has 12 rows of 16"),
    "of-another-scene": ("lasting", "its answer is of another scene: its digest is '000"),
    "of-another-job": ("once", "it answered job 'another' and not "),
    "hangs-before": ("lasting", "no answer within 0.7 s; it wrote nothing"),
    "hangs-after": ("once", "no answer within 0.7 s; it wrote nothing"),
    "answers-late": ("lasting", "no answer within 0.7 s; it wrote nothing"),
}
HARMLESS = ("answers-late", "answers-twice", "leaves-a-child", "starts-slowly", "slow", "chatters")


@pytest.fixture(scope="module")
def pool():
    """One for all tests: what a fault does to it, the tests that follow have to live with."""
    with Pool(threads=1, file_limit=FILE_LIMIT) as pool:
        yield pool


def render(pool: Pool, folder: Path, fault: str = "", replicate: int = 0, timeout: float = 20.0) -> Result:
    """One trial of the renderer with a fault, without one of the honest renderer, both in the same process."""
    method = entry(fault, worker="shared")
    return pool.render(method, SCENE, trial(method, replicate), folder / f"{fault}-{replicate}.exr", timeout)


def render_outside(pool: Pool, folder: Path, fault: str, mode: str, replicate: int = 0, timeout: float = 20.0) -> Result:
    """One trial of tests/outside_faults.py; all of these programs are asked by the same worker."""
    path = folder / f"{fault}-{mode}.toml"
    script = Path(__file__).with_name("outside_faults.py")
    path.write_text(f"""name = "{fault}-{mode}"\nmode = "{mode}"
command = ["python3", "{script}", "{mode}", "{fault}"]\nversion = ["python3", "{script}", "--version"]\n""")
    method = replace(manifest.read(path).entry(path), worker="outside")
    return pool.render(method, SCENE, trial(method, replicate), folder / f"{fault}-{mode}.exr", timeout)


def is_right(result: Result) -> bool:
    """Whether a film is the honest renderer's, to the last digit."""
    noise = np.random.default_rng(result.trial.seed).normal(size=SCENE.size) / 8
    return result.status is Status.OK and np.allclose(result.film, light(SCENE) * (1 + noise), rtol=1e-13)


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_costs_its_own_trial(pool, tmp_path, fault):
    """The record says what happened and what the renderer wrote last; the honest method beside it renders before and after."""
    before, faulty, after = (render(pool, tmp_path, *which) for which in (("", 0), (fault, 0), ("", 1)))
    assert is_right(before) and is_right(after)
    assert (faulty.status, faulty.film) == (Status.ERROR, None)
    assert FAULTS[fault] in faulty.message
    assert faulty.message.isprintable()
    assert not list(tmp_path.glob("*.partial"))
    assert ("(at the second attempt too)" in faulty.message) == (fault in TRIED_AGAIN)


@pytest.mark.parametrize("fault", TIME_OUTS)
def test_a_renderer_that_hangs_is_killed(pool, tmp_path, fault):
    """No answer in time: killed for good, even where it ignores a polite signal, not tried again, and replaced."""
    render(pool, tmp_path)
    process = psutil.Process(pool._workers["shared"]._process.pid)
    faulty = render(pool, tmp_path, fault, timeout=0.5)
    assert (faulty.status, faulty.message) == (Status.ERROR, TIME_OUTS[fault])
    assert not process.is_running()
    assert is_right(render(pool, tmp_path, replicate=1))


@pytest.mark.parametrize("fault", OUTSIDE)
def test_a_fault_outside_costs_its_own_trial(pool, tmp_path, fault):
    """The same of programs, whose faults their workers live through; who hangs is killed with its worker."""
    mode, message = OUTSIDE[fault]
    faulty = render_outside(pool, tmp_path, fault, mode, timeout=0.7 if "no answer" in message else 20.0)
    assert (faulty.status, faulty.film) == (Status.ERROR, None)
    assert message in faulty.message
    assert faulty.message.isprintable()
    assert is_right(render(pool, tmp_path))


def test_a_program_that_starts_slowly_is_waited_for(pool, tmp_path):
    """A second before it reads its first job: a film like any other."""
    assert render_outside(pool, tmp_path, "starts-slowly", "lasting").status is Status.OK


def test_a_renderer_that_never_starts_is_given_up(tmp_path):
    """It hangs before its first job: no answer within the pool's patience, and it is not started again for the next trial."""
    with Pool(threads=1, patience=0.5) as pool:
        first, second = (render(pool, tmp_path, "hangs-before", replicate) for replicate in (0, 1))
        assert first.message.startswith("while starting the renderer: no answer within 0.5 s")
        assert first.message == second.message
        assert not pool._workers


@pytest.mark.parametrize("fault", HARMLESS)
def test_what_does_no_harm_costs_nothing(tmp_path, fault):
    """An answer to a request of before, the same answer twice, a child left behind, a slow start, in each trial more than half
    of the output that is allowed: right films, all of them."""
    with Pool(threads=1, file_limit=FILE_LIMIT) as pool:
        assert all(is_right(render(pool, tmp_path, fault, replicate)) for replicate in range(3))
        assert is_right(render(pool, tmp_path))


def test_processes_left_behind_do_not_pile_up(tmp_path):
    """A child left by every trial: the worker is replaced before there are many, and no film is lost."""
    with Pool(threads=1) as pool:
        assert all(is_right(render(pool, tmp_path, "leaves-a-child", replicate)) for replicate in range(40))
        (worker,) = pool._workers.values()
        assert len(psutil.Process(worker._process.pid).children(recursive=True)) <= 20


def test_a_crash_is_retried_once(tmp_path, monkeypatch):
    """A renderer that crashes once: the trial succeeds at the second attempt, and says so."""
    monkeypatch.setenv("MISBEHAVING_FLAG", str(tmp_path / "flag"))
    with Pool(threads=1) as pool:
        result = render(pool, tmp_path, "crashes-once")
    assert is_right(result)
    assert "the first attempt failed while rendering: its process was killed by SIGSEGV" in result.message


def test_faults_leave_nothing_behind(tmp_path):
    """Two dozen faulty trials: as many open files and processes as before, and no more memory to speak of."""
    faults = ("exits-mid-job", "segfaults", "raises", "floods", "writes-half-an-image", "nan")
    here = psutil.Process()
    children = here.children()
    with Pool(threads=1, file_limit=FILE_LIMIT) as pool:
        for replicate in range(4):
            if replicate == 1:
                files, memory = here.num_fds(), here.memory_info().rss
            assert {render(pool, tmp_path, fault, replicate).status for fault in faults} == {Status.ERROR}
        assert here.num_fds() == files
    assert here.children() == children
    assert here.memory_info().rss - memory < 20e6
