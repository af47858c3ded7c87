"""Files from strangers are data: whatever they hold is read, or refused with an error that says what is wrong."""

from __future__ import annotations

import copy
import json
import os
import tempfile
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy
from test_store import RUN, recorded, trial

from lightproof import baseline, films, plan, references, scene_file, store, suite
from lightproof.baseline import BaselineError
from lightproof.checked import SceneError
from lightproof.cli import main
from lightproof.films import FilmError
from lightproof.judging import Judge
from lightproof.references import ReferenceError
from lightproof.renderers import manifest, protocol
from lightproof.renderers.protocol import AnswerError, FilmFile, Job
from lightproof.renderers.registry import METHODS
from lightproof.store import StoreError

ROOT = suite.default().root
SCENE = suite.default().scene("point-light")
SCRATCH = tempfile.TemporaryDirectory(prefix="lightproof-fuzz-")
FOLDER = Path(SCRATCH.name)
EXAMPLES = 40

MANIFEST = {
    "name": "my-renderer", "command": ["./render", "--quiet"], "version": ["./render", "--version"], "mode": "lasting",
    "deterministic": False, "samples_lights": True, "precision": "float32",
    "supports": {"quantities": ["irradiance"], "films": ["plane"], "lights": ["area"], "shapes": ["polygon"], "reflections": 0},
}  # fmt: skip
MANIFEST_FILE = b'name = "mine"\ncommand = ["./a"]\nversion = ["./a", "-v"]\n[supports]\nfilms = ["plane"]\n'
JOB = Job("a1", SCENE.digest, SCENE.to_table(), 64, 7, 2, FilmFile(str(FOLDER / "film.exr"), *SCENE.film.grid))
ANSWER = {
    "job": "a1", "digest": SCENE.digest, "film": [1.0] * SCENE.size, "samples": 64, "variance": [0.1] * SCENE.size,
    "quantization": [0.0] * SCENE.size, "seconds": {"setup": 0.1, "compile": 0.0},
}  # fmt: skip


@dataclass(frozen=True)
class Reader:
    """What is read, by whom, and the errors that may come of it."""

    inputs: SearchStrategy
    read: Callable[[Any], Any]
    errors: tuple[type[Exception], ...]


def film() -> bytes:
    """A whole film of three channels."""
    path = FOLDER / "whole.exr"
    values = np.random.default_rng(1).random((2, SCENE.size))
    films.write(path, SCENE.film.grid, {"Y": values[0], "variance": values[1]}, {"digest": SCENE.digest})
    return path.read_bytes()


def run() -> tuple[dict[str, Any], dict[str, Any]]:
    """A run's header, and the line of a trial whose film is there."""
    options = {"budget": 1.0, "cell_budget": 1.0, "replicates": 16, "methods": [asdict(METHODS["mitsuba/scalar"])],
               "suites": {SCENE.name: str(ROOT)}}
    record = store.create(FOLDER, replace(RUN, options=options), [SCENE])
    recorded(record, trial())
    return json.loads((record.folder / "run.json").read_bytes()), json.loads((record.folder / "trials.jsonl").read_bytes())


def mutated(*corpus: bytes) -> SearchStrategy:
    """A file of the corpus with some bytes replaced, taken out or put in, perhaps cut off; or no such file at all."""
    edit = st.tuples(st.integers(0, 1 << 20), st.integers(0, 8), st.binary(max_size=8))
    edits = st.builds(_edited, st.sampled_from(corpus), st.lists(edit, max_size=4), st.integers(0, 1 << 20) | st.none())
    return edits | st.binary(max_size=64)


def _edited(data: bytes, edits: list[tuple[int, int, bytes]], end: int | None) -> bytes:
    for place, length, new in edits:
        place %= len(data) + 1
        data = data[:place] + new + data[place + length:]
    return data if end is None else data[: end % (len(data) + 1)]


NUMBERS = st.integers() | st.floats() | st.sampled_from([2**31, 2**63, 10**400, 1e308, 5e-324, -0.0])
WORDS = st.text(max_size=8) | st.sampled_from(["../../etc/passwd", "/dev/zero", "\x1b[2J", "<script>", "all", "file", "\ud800"])
VALUES = st.recursive(
    st.none() | st.booleans() | NUMBERS | WORDS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(WORDS, inner, max_size=4),
    max_leaves=8,
)


def grafted(*tables: dict[str, Any]) -> SearchStrategy:
    """A table with other values at some places, or without them, or with more."""
    graft = st.tuples(st.lists(st.integers(0, 30), min_size=1, max_size=5), st.just(...) | VALUES)
    return st.builds(_grafted, st.sampled_from(tables), st.lists(graft, max_size=3))


def _grafted(table: dict[str, Any], grafts: list[tuple[list[int], Any]]) -> dict[str, Any]:
    table = copy.deepcopy(table)
    for path, value in grafts:
        place: Any = table
        *parents, last = path
        for step in parents:
            inner = _inside(place, step)
            place = inner if isinstance(inner, dict | list) and inner else place
        key = _keys(place)[last % len(place)] if place else None
        if value is ... and place:
            del place[key]
        elif place:
            place[key] = value
    return table


def _keys(place: dict | list) -> list:
    return list(place) if isinstance(place, dict) else list(range(len(place)))


def _inside(place: dict | list, step: int) -> Any:
    return place[_keys(place)[step % len(place)]] if place else None


def written(name: str, data: bytes) -> Path:
    path = FOLDER / name
    path.write_bytes(data)
    return path


def as_json(table: Any) -> bytes:
    return json.dumps(table).encode()


def read_record(header: dict[str, Any], line: dict[str, Any]) -> None:
    """What a run comes to that holds a header and one line, and what would be rendered if it were resumed."""
    written(f"{RUN.id}/run.json", as_json(header))
    written(f"{RUN.id}/trials.jsonl", as_json(line) + b"\n")
    record = store.open(FOLDER / RUN.id)
    judge = Judge(record)
    for result in record.results():
        assert record.film_path(result.trial).resolve().is_relative_to(record.folder.resolve())
        judge.judge([result])
    for cell in plan.cells(record):
        assert cell.next_trial(record.run.seed)


def read_reference(data: bytes, suffix: str) -> Any:
    for each in ("csv", "toml"):
        written(f"point-light.{each}", (ROOT / f"references/point-light.{each}").read_bytes())
    written(f"point-light.{suffix}", data)
    return references.read(FOLDER, SCENE)


def read_answer(data: bytes) -> Any:
    return protocol.read_answer(data, JOB)


def of_file(name: str, read: Callable[[Path], Any]) -> Callable[[bytes], Any]:
    return lambda data: read(written(name, data))


SCENES = [path.read_bytes() for path in sorted((ROOT / "scenes").glob("*.toml"))]
HEADER, LINE = run()
READERS = {
    "scene file": Reader(mutated(*SCENES), of_file("a-scene.toml", scene_file.read_cases), (SceneError,)),
    "scene": Reader(grafted(*(each.to_table() for each in suite.default().scenes())),
                    lambda table: scene_file.from_table(table, "a-scene"), (SceneError,)),
    "manifest file": Reader(mutated(MANIFEST_FILE), of_file("manifest.toml", manifest.read), (SceneError,)),
    "manifest": Reader(grafted(MANIFEST), manifest.Manifest.from_table, (SceneError,)),
    "job": Reader(grafted(JOB.to_table()), Job.from_table, (SceneError,)),
    "answer": Reader(grafted(ANSWER, {**ANSWER, "film": "file"}).map(as_json) | mutated(as_json(ANSWER)), read_answer,
                     (AnswerError, FilmError)),
    "film": Reader(mutated(film()), of_file("a-film.exr", films.read), (FilmError,)),
    "record": Reader(grafted(LINE), lambda table: read_record(HEADER, table), (StoreError, FilmError)),
    "run": Reader(grafted(HEADER), lambda table: read_record(table, LINE), (StoreError, FilmError)),
    "reference": Reader(mutated((ROOT / "references/point-light.toml").read_bytes()),
                        lambda data: read_reference(data, "toml"), (ReferenceError,)),
    "values": Reader(mutated((ROOT / "references/point-light.csv").read_bytes()),
                     lambda data: read_reference(data, "csv"), (ReferenceError,)),
    "baseline": Reader(mutated((ROOT / "reports/baseline.csv").read_bytes()), of_file("baseline.csv", baseline.read),
                       (BaselineError,)),
}  # fmt: skip


def fuzz(reader: Reader, examples: int) -> dict[str, int]:
    """Read so many inputs; how many were accepted, and how many refused. Whatever else a reader raises comes out of it."""
    counts = {"accepted": 0, "refused": 0}

    @settings(max_examples=examples, deadline=None, database=None, suppress_health_check=list(HealthCheck))
    @given(reader.inputs)
    def read(given_input: Any) -> None:
        try:
            reader.read(given_input)
        except reader.errors as error:
            assert str(error).isprintable()
            counts["refused"] += 1
        else:
            counts["accepted"] += 1

    read()
    return counts


@pytest.mark.parametrize("name", READERS)
def test_any_input_is_accepted_or_refused(name):
    """Nothing but the documented errors, and these fit for a terminal; of what is nearly right, some is refused."""
    assert fuzz(READERS[name], EXAMPLES)["refused"] > 0


@pytest.mark.parametrize("name", ["\x1b[2Jscene", "<script>alert(1)<script>", "..", "a\u202eb"])
def test_a_suite_of_strangely_named_files_is_refused_in_plain_words(tmp_path, capsys, name):
    """A scene file named to clear the screen, to run in a browser, or to lead out of its folder: told, and harmless to tell."""
    (tmp_path / "scenes").mkdir()
    (tmp_path / f"scenes/{name}.toml").write_bytes(SCENES[0])
    assert main(["list", "--suite", str(tmp_path)]) == 2
    told = capsys.readouterr().err
    assert "is not an id; give lower-case words" in told
    assert told.rstrip("\n").isprintable()


@pytest.mark.parametrize("film", ["../../../etc/passwd", "/dev/zero", "films/../../secret.exr"])
def test_no_record_leads_out_of_its_run(film):
    """A line that names another file as its film: the film of its trial is read, where it has to stand."""
    read_record(HEADER, {**LINE, "film": film})
    with pytest.raises(StoreError, match="there is no scene"):
        read_record(HEADER, {**LINE, "trial": {**LINE["trial"], "scene": ".."}})
    with pytest.raises(StoreError, match="is not an id"):
        read_record({**HEADER, "scenes": [{**HEADER["scenes"][0], "id": "../secret"}]}, LINE)


@pytest.mark.parametrize(("reader", "data", "message"), [
    ("scene file", b"#" * (scene_file.MAX_BYTES + 1), "larger than"),
    ("manifest file", b"#" * (scene_file.MAX_BYTES + 1), "larger than"),
    ("scene file", b"tolerance = " + b"9" * 5000, "is not TOML"),
    ("scene file", b"a" + b".a" * 100_000 + b" = 1", "a key of more than 32 parts"),
    ("manifest file", b"[a" + b" . 'a'" * 100_000 + b"]", "a key of more than 32 parts"),
    ("reference", b"a" + b".a" * 100_000 + b" = 1", "a key of more than 32 parts"),
    ("reference", b"a = " + b"[" * 100_000, "is not TOML"),
    ("answer", b"[" * 100_000, "which is no JSON"),
    ("answer", as_json({**ANSWER, "samples": 10**400}), "whole number"),
])
def test_what_is_too_large_or_too_deep_says_so(reader, data, message):
    """A megabyte of comments, a hundred thousand brackets, keys that the parser would take hours over, 400 digits."""
    with pytest.raises(READERS[reader].errors, match=message):
        READERS[reader].read(data)


def test_what_is_no_file_is_not_waited_for(tmp_path):
    """A pipe that nobody writes to, in the place of a scene, its reference, a manifest, a film, a run: refused at once."""
    for name in ("a.toml", "point-light.toml", "run.json"):
        os.mkfifo(tmp_path / name)
    for read, refused in (
        (lambda: scene_file.read_cases(tmp_path / "a.toml"), SceneError),
        (lambda: manifest.read(tmp_path / "a.toml"), SceneError),
        (lambda: references.read(tmp_path, SCENE), ReferenceError),
        (lambda: films.read(tmp_path / "a.toml"), FilmError),
        (lambda: store.open(tmp_path), StoreError),
    ):
        with pytest.raises(refused):
            read()
