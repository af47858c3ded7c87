"""A run's record: appended to, never overwritten, and worth reading after a kill."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from lightproof import films, store, suite
from lightproof.store import Run, StoreError
from lightproof.trial import Result, Status, Trial

SCENES = [suite.default().scene(name) for name in ("point-light", "square-light:far")]
RUN = Run(
    id="20260101-000000-cafe",
    started="2026-01-01T00:00:00+00:00",
    suite_digest="0" * 64,
    machine="an abacus",
    threads=2,
    seed=3,
    versions={"lightproof": "0", "mitsuba": "3"},
    commit="abc+",
    options={"budget": 1.5},
)


def trial(samples: int = 64, replicate: int = 0, method: str = "mitsuba/scalar") -> Trial:
    return Trial("point-light", "base", SCENES[0].digest, method, samples, replicate, run_seed=3)


def recorded(record: store.Store, trial: Trial, **fields) -> Result:
    """A result with a film of noise, whose image stands where the store wants it, appended to the record."""
    film, *told = np.random.default_rng(trial.seed).random((3, SCENES[0].size))
    variance, bound = (one.astype(np.float32).astype(float) for one in told)
    path = record.film_path(trial)
    path.parent.mkdir(parents=True, exist_ok=True)
    films.write(path, SCENES[0].film.grid, {"Y": film, "variance": variance, "bound": bound}, {"method": trial.method})
    result = Result(trial, Status.OK, film=film, variance=variance, bound=bound, samples=70, **fields)
    record.append(result)
    return result


def same(one: Result, other: Result) -> bool:
    arrays = ("film", "variance", "quantization", "bound")
    plain = [{name: value for name, value in vars(result).items() if name not in arrays} for result in (one, other)]
    close = (np.allclose(getattr(one, name), getattr(other, name), rtol=1e-13, atol=0) for name in arrays)
    return plain[0] == plain[1] and all(close)


def test_what_is_recorded_comes_back(tmp_path):
    """A run with two results, opened again: the run, its scenes, and both results in order with their films."""
    record = store.create(tmp_path, RUN, SCENES)
    settings = {"integrator": "direct", "passes": [64, 64]}
    first = recorded(record, trial(), seconds={"render": 0.25, "setup": 1.5}, version="3.1", settings=settings,
                     precision="float32", threads=2, samples_lights=True, peak_memory_mb=12.5)  # fmt: skip
    second = Result(trial(256), Status.ERROR, message="out of photons\n\x1b[31m")
    record.append(second)
    again = store.open(tmp_path / RUN.id)
    assert again.run == RUN
    assert again.scenes == tuple(SCENES)
    results = again.results()
    assert same(results[0], first)
    assert results[1] == second


def test_a_new_run_has_no_results(tmp_path):
    """A run killed before its first trial: opened, with nothing in it."""
    store.create(tmp_path, RUN, SCENES)
    assert store.open(tmp_path / RUN.id).results() == []


@pytest.mark.parametrize("torn", [b'{"trial": {"scene": "poi', b"\x00\x00"])
def test_a_torn_last_line_is_no_loss(tmp_path, torn):
    """A kill in the middle of a line: what was recorded before is read, and what is appended later is too."""
    record = store.create(tmp_path, RUN, SCENES)
    recorded(record, trial())
    lines = record.folder / "trials.jsonl"
    lines.write_bytes(lines.read_bytes() + torn)
    del record
    again = store.open(tmp_path / RUN.id)
    assert [result.trial for result in again.results()] == [trial()]
    again.append(Result(trial(256), Status.UNSUPPORTED))
    assert [result.trial.samples for result in again.results()] == [64, 256]


def test_a_broken_line_in_the_middle_is_named(tmp_path):
    """An edited record: the number of the line that is no trial."""
    record = store.create(tmp_path, RUN, SCENES)
    recorded(record, trial())
    with (record.folder / "trials.jsonl").open("ab") as lines:
        lines.write(b'{"trial": {}}\n')
    with pytest.raises(StoreError, match="line 2 is no trial"):
        store.open(record.folder).results()


def test_a_lost_film_is_named(tmp_path):
    """A film that somebody deleted: its path."""
    record = store.create(tmp_path, RUN, SCENES)
    recorded(record, trial())
    record.film_path(trial()).unlink()
    with pytest.raises(films.FilmError, match="64-0-"):
        record.results()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="only Linux has a device that is always full")
def test_a_full_disk_is_named(tmp_path):
    """A record on a full disk: refused with what to do about it."""
    record = store.create(tmp_path, RUN, SCENES)
    with Path("/dev/full").open("wb", buffering=0) as full:
        record.__dict__["_lines"] = full
        with pytest.raises(StoreError, match=r"No space left.*--resume"):
            record.append(Result(trial(), Status.ERROR))


def test_one_writer_at_a_time(tmp_path):
    """Two processes that carry on with the same run: the second is refused."""
    record = store.create(tmp_path, RUN, SCENES)
    recorded(record, trial())
    with pytest.raises(StoreError, match="another process is writing"):
        store.open(record.folder).append(Result(trial(256), Status.ERROR))


def test_films_of_different_trials_never_meet(tmp_path):
    """Methods whose names differ only in what a file name cannot hold: different films."""
    record = store.create(tmp_path, RUN, SCENES)
    names = ["mine/a", "mine:a", "mine_a", "../mine_a"]
    paths = {record.film_path(trial(method=name)) for name in names}
    assert len(paths) == len(names)
    assert all(path.resolve().is_relative_to(record.folder.resolve() / "films") for path in paths)


def test_a_run_is_never_overwritten(tmp_path):
    """The same id twice: refused."""
    store.create(tmp_path, RUN, SCENES)
    with pytest.raises(StoreError, match="cannot be written"):
        store.create(tmp_path, RUN, SCENES)


@pytest.mark.parametrize("content", [None, "", "[]", '{"name": "somebody else"}', '{"format": "lightproof run 99"}'])
def test_a_foreign_folder_is_refused(tmp_path, content):
    """A folder that holds no run of this format: refused, and told what would be one."""
    if content is not None:
        (tmp_path / "run.json").write_text(content)
    with pytest.raises(StoreError, match=r"lightproof.* made"):
        store.open(tmp_path)


def test_a_run_without_its_scenes_is_refused(tmp_path):
    """run.json of the right format that lacks fields: refused."""
    (tmp_path / "run.json").write_text(json.dumps({"format": store.FORMAT}))
    with pytest.raises(StoreError, match="is broken"):
        store.open(tmp_path)


@pytest.mark.parametrize("parent", ["file", "file/below"])
def test_an_unwritable_folder_is_refused(tmp_path, parent):
    """A file in place of the output folder: refused before anything runs, and when the run is created."""
    (tmp_path / "file").write_text("")
    with pytest.raises(StoreError, match=r"cannot be written.*--out"):
        store.check_writable(tmp_path / parent)
    with pytest.raises(StoreError, match=r"cannot be written.*--out"):
        store.create(tmp_path / parent, RUN, SCENES)


def test_the_latest_run(tmp_path: Path):
    """Two runs: the one that started later; none: what makes one."""
    with pytest.raises(StoreError, match="lightproof run"):
        store.latest(tmp_path)
    for number in (2, 1):
        store.create(tmp_path, Run(**{**vars(RUN), "id": f"2026010{number}-000000-cafe"}), SCENES)
    assert store.latest(tmp_path).run.id.startswith("20260102")
