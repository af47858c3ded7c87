"""One renderer, one process: whatever it does costs its own trial and nothing else."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import psutil
import pytest
from misbehaving import light

from lightproof import films, suite
from lightproof.method import Unavailable
from lightproof.renderers.pool import MethodFailed, Pool, read_film
from lightproof.renderers.process import Worker, WorkerDied, WorkerTimeout
from lightproof.renderers.registry import Entry
from lightproof.renderers.worker import phases
from lightproof.trial import Result, Status, Trial

FILE_LIMIT = 1 << 20
SCENE = suite.default().scene("point-light")
TARGET = f"{Path(__file__).with_name('misbehaving.py')}:Misbehaving"


def entry(fault: str = "", worker: str = "misbehaving") -> Entry:
    return Entry(f"misbehaving/{fault}" if fault else "misbehaving", TARGET, worker=worker)


def trial(method: Entry, replicate: int = 0, scene=SCENE) -> Trial:
    return Trial(scene.id, scene.case, scene.digest, method.name, samples=64, replicate=replicate)


@pytest.fixture(scope="module")
def pool():
    """One for all tests: what a fault does to it, the tests that follow have to live with."""
    with Pool(threads=1, file_limit=FILE_LIMIT) as pool:
        yield pool


@pytest.fixture
def render(pool, tmp_path):
    """One trial of a method."""

    def render(method: Entry, replicate: int = 0, scene=SCENE, timeout: float = 20.0) -> Result:
        film = tmp_path / f"{method.name.replace('/', '-')}-{replicate}.exr"
        return pool.render(method, scene, trial(method, replicate, scene), film, timeout)

    return render


def test_a_film_comes_back_as_it_was_rendered(render, tmp_path):
    """Point light above a floor: I cos / r2 in every cell, with the noise that the trial's seed draws."""
    result = render(entry())
    noise = np.random.default_rng(result.trial.seed).normal(size=SCENE.size) / 8
    np.testing.assert_allclose(result.film, light(SCENE) * (1 + noise), rtol=1e-13)
    assert (result.status, result.samples, result.version, result.message) == (Status.OK, 64, "1.0", "")
    assert set(result.seconds) == {"setup", "render"}
    assert result.peak_memory_mb > 10


def test_a_film_says_what_it_is(render, tmp_path):
    """The image's header: scene, case, digest, quantity, unit, method, version, samples, seed."""
    result = render(entry())
    _, _, header = films.read(next(tmp_path.glob("*.exr")))
    expected = {
        "scene": "point-light", "case": "base", "digest": SCENE.digest, "quantity": "irradiance",
        "unit": "W/m\N{SUPERSCRIPT TWO}", "method": "misbehaving", "method_version": "1.0", "samples": "64",
        "seed": str(result.trial.seed),
    }  # fmt: skip
    assert {key: header[key] for key in expected} == expected


def test_a_worker_stays_up_between_trials(pool, render):
    """Two replicates and a second method of the same family: one process, and two different films."""
    first = render(entry())
    worker = pool._workers["misbehaving"]
    second, other = render(entry(), replicate=1), render(entry("identical"))
    assert {result.status for result in (first, second, other)} == {Status.OK}
    assert (first.film != second.film).all()
    assert pool._workers == {"misbehaving": worker}


def test_what_a_method_cannot_do_is_unsupported(render):
    """An area light for a renderer of point lights: its own reason, not an error."""
    result = render(entry(), scene=suite.default().scene("square-light"))
    assert (result.status, result.message) == (Status.UNSUPPORTED, "misbehaving has point lights only")


def test_what_is_not_installed_says_how_to_install_it(pool, render):
    """A renderer that is not there: the command that installs it; asking again does not start it again."""
    with pytest.raises(Unavailable, match="pip install"):
        pool.open(entry("not-installed"))
    result = render(entry("not-installed"))
    assert (result.status, result.message) == (Status.UNSUPPORTED, "pip install 'lightproof[misbehaving]'")


def test_children_die_with_their_renderer(tmp_path):
    """A renderer that leaves a child in a session of its own: killed when the worker is."""
    leaver = entry("leaves-a-child")
    with Pool(threads=1) as pool:
        assert pool.render(leaver, SCENE, trial(leaver), tmp_path / "film.exr", 20).status is Status.OK
        (child,) = psutil.Process(pool._workers["misbehaving"]._process.pid).children()
    psutil.wait_procs([child], timeout=10)
    assert not child.is_running() or child.status() == psutil.STATUS_ZOMBIE


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells a process that its parent died")
def test_workers_die_with_the_harness(tmp_path):
    """A harness killed by SIGKILL while its worker hangs: the worker is gone too."""
    script = f"""
import sys
from pathlib import Path
sys.path.insert(0, {str(Path(__file__).parent)!r})
from test_process import *
pool = Pool(threads=1)
pool.open(entry("hangs"))
print(pool._workers["misbehaving"]._process.pid, flush=True)
pool.render(entry("hangs"), SCENE, trial(entry("hangs")), Path({str(tmp_path)!r}) / "film.exr", 3600)
"""
    harness = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE)
    worker = psutil.Process(int(harness.stdout.readline()))
    harness.kill()
    harness.wait()
    psutil.wait_procs([worker], timeout=10)
    assert not worker.is_running() or worker.status() == psutil.STATUS_ZOMBIE


def test_a_method_that_fails_to_start_is_not_started_again(pool, monkeypatch):
    """A renderer that exits as it starts: the same complaint twice, from one process."""
    monkeypatch.setattr(pool, "_unable", {})
    with pytest.raises(WorkerDied) as first:
        pool.open(entry("exits-at-once"))
    monkeypatch.setattr("lightproof.renderers.pool.Worker", None)
    with pytest.raises(WorkerDied) as second:
        pool.open(entry("exits-at-once"))
    assert second.value is first.value


@pytest.mark.parametrize(("target", "message"), [
    ("no_such_module:Renderer", "ModuleNotFoundError"),
    ("lightproof.method:NoSuchClass", "AttributeError"),
    ("/no/such/file.py:Renderer", "FileNotFoundError"),
])  # fmt: skip
def test_a_target_that_is_not_there(pool, target, message):
    """A class that cannot be imported: an error that says why."""
    with pytest.raises(MethodFailed, match=message):
        pool.open(Entry(target, target, worker="misbehaving"))


def test_a_film_of_another_scene_is_refused(render, tmp_path):
    """A film whose header names another digest: refused, with the digest that would be right."""
    render(entry())
    with pytest.raises(films.FilmError, match=suite.default().scene("point-light:near").digest):
        read_film(next(tmp_path.glob("*.exr")), suite.default().scene("point-light:near"))


def test_a_closed_worker_can_be_closed_again():
    """Closing twice is harmless, and an answer that never comes is a time-out."""
    worker = Worker(threads=1)
    with pytest.raises(WorkerTimeout):
        worker.ask("open", timeout=0.0, method="hangs", target=TARGET, threads=1)
    worker.close()


def test_a_worker_that_does_not_read_is_not_waited_for():
    """A worker that was stopped, and a request larger than a pipe holds: no answer in time."""
    worker = Worker(threads=1)
    worker._process.send_signal(signal.SIGSTOP)
    with pytest.raises(WorkerTimeout):
        worker.ask("prepare", timeout=0.2, method="any", table={"title": "long " * 100_000})


def test_phases_add_up_to_the_clock():
    """Of 5 s a method names 2 s of compiling: 3 s are rendering; its own claim about rendering counts for nothing."""
    assert phases({"compile": 2.0, "render": 0.1}, 5.0, rest="render") == {"compile": 2.0, "render": 3.0}


@pytest.mark.parametrize(("claimed", "believed"), [(1e9, 5.0), (-1e9, 0.0), (float("nan"), 0.0), (float("inf"), 5.0)])
def test_a_phase_is_no_longer_than_the_clock_says(claimed, believed):
    """Of 5 s a method claims too much, less than nothing, or no number: no other method's share of the budget depends on it."""
    assert phases({"setup": claimed}, 5.0, rest="render") == {"setup": believed, "render": 5.0 - believed}
