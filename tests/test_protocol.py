"""A renderer in any language: what its manifest may say, what it may answer, and what it costs when it does neither."""

from __future__ import annotations

import contextlib
import json
import re
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import jsonschema
import numpy as np
import psutil
import pytest
from misbehaving import light

from lightproof import films, scene_file, store, suite
from lightproof.cli import main, selection
from lightproof.method import Unavailable
from lightproof.renderers import manifest, protocol, schema
from lightproof.renderers.pool import Pool
from lightproof.renderers.protocol import AnswerError, FilmFile, Job
from lightproof.scene import Scene
from lightproof.trial import Result, Status, Trial

SUITE = suite.default()
SCENE = SUITE.scene("point-light")
RENDERER = Path(__file__).with_name("outside_renderer.py")
EXAMPLES = Path(__file__).parents[1] / "examples"
UNLUCKY = 13
MANIFEST = """
name    = "{name}"
mode    = "{mode}"
command = ["python3", "{renderer}", "{mode}", "{fault}"]
version = ["python3", "{renderer}", "--version"]
"""


def described(folder: Path, mode: str = "lasting", fault: str = "none", more: str = "") -> Path:
    """The manifest of tests/outside_renderer.py with a fault."""
    path = folder / f"{fault}-{mode}.toml"
    path.write_text(MANIFEST.format(name=f"{fault}-{mode}", mode=mode, fault=fault, renderer=RENDERER) + more)
    return path


@pytest.fixture(scope="module")
def pool():
    """One for all tests, in which one worker asks all programs: what one does to it, the others have to live with."""
    with Pool(threads=1, file_limit=1 << 22) as pool:
        yield pool


@pytest.fixture
def render(pool, tmp_path):
    """A trial of the renderer that a manifest describes."""

    def render(path: Path, samples: int = 64, replicate: int = 0, scene: Scene = SCENE, timeout: float = 20.0) -> Result:
        entry = replace(manifest.read(path).entry(path), worker="outside")
        trial = Trial(scene.id, scene.case, scene.digest, entry.name, samples, replicate)
        return pool.render(entry, scene, trial, tmp_path / "film.exr", timeout)

    return render


@pytest.mark.parametrize("mode", ["once", "lasting"])
def test_an_honest_renderer_outside(render, tmp_path, mode):
    """Point light over a plane, relative noise 0.2 / sqrt(64): films of the right size and noise, the variance as it was given,
    and what it cannot do in its own words."""
    path = described(tmp_path, mode)
    first, second = render(path), render(path, replicate=1)
    assert (first.status, first.version, first.samples, first.threads) == (Status.OK, "outside 1.0", 64, 1)
    assert (first.film != second.film).all()
    deviations = np.concatenate([(result.film - light(SCENE)) / (0.2 / 8 * light(SCENE)) for result in (first, second)])
    assert 0.85 < deviations.std() < 1.15
    np.testing.assert_allclose(first.variance, (0.2 * light(SCENE)) ** 2 / 64, rtol=1e-6)
    declined = render(path, scene=SUITE.scene("square-light"))
    assert (declined.status, declined.message) == (Status.UNSUPPORTED, "one point light over a plane, and nothing else")


@pytest.mark.parametrize(("fault", "mode", "message"), [
    ("garbage", "lasting", "it wrote 'Rendering: 100 % done' to its standard output, which is no JSON"),
    ("exits", "once", "it exited with status 1 before it answered; it last wrote: out of photons [2J<script>"),
    ("crashes", "lasting", "it was killed by SIGSEGV before it answered"),
    ("fails-after", "once", "it answered, but then it exited with status 4"),
    ("hangs", "lasting", "no answer within 1 s"),
    ("hangs", "once", "no answer within 1 s"),
    ("closes-output", "lasting", "it closed its standard output before it answered"),
    ("floods", "lasting", "and so on; an answer is a line of at most 67,108,864 bytes"),
    ("floods-errors", "lasting", "it exited with status 1 before it answered; it last wrote: light light"),
    ("twice", "once", "after its answer; it must answer each job once"),
    ("half-an-image", "lasting", "is no OpenEXR image"),
    ("no-file", "lasting", 'its film is "file", but it wrote no film.exr at the path that the job names'),
    ("negative", "lasting", "1 of 192 values of Y are no light, the first -1 in element 0"),
])  # fmt: skip
def test_a_fault_costs_its_own_trial(render, tmp_path, fault, mode, message):
    """A renderer that misbehaves on one job of three: that one is an error which says how; the other two are films."""
    path = described(tmp_path, mode, fault)
    before = render(path)
    faulty = render(path, UNLUCKY, timeout=1.0 if fault == "hangs" else 20.0)
    after = render(path, replicate=1)
    assert (before.status, faulty.status, after.status) == (Status.OK, Status.ERROR, Status.OK)
    assert message in faulty.message
    assert faulty.film is None


def test_the_last_line_needs_no_end(tmp_path):
    """A version, or an answer, printed without a newline before the program ends."""
    (tmp_path / "mine.toml").write_text('name = "mine"\ncommand = ["true"]\nversion = ["printf", "mine 1.0"]\n')
    (entry,) = selection.methods([str(tmp_path / "mine.toml")], [])
    with Pool(threads=1) as pool:
        assert pool.open(entry).version == "mine 1.0"


def test_an_answer_too_many_is_noticed_late(render, tmp_path):
    """A second answer that comes when the first has been taken costs the next trial, and no more."""
    path = described(tmp_path, fault="twice-later")
    statuses = [render(path, samples, replicate).status for replicate, samples in enumerate([64, UNLUCKY, 64, 64])]
    assert statuses == [Status.OK, Status.OK, Status.ERROR, Status.OK]


def test_what_a_renderer_leaves_behind_goes_with_it(tmp_path):
    """A child in a session of its own, and scratch files: killed and deleted when the worker ends."""
    (entry,) = selection.methods([str(described(tmp_path, "once", "leaves-a-child"))], [])
    trial = Trial(SCENE.id, SCENE.case, SCENE.digest, entry.name, UNLUCKY, 0)
    with Pool(threads=1) as pool:
        assert pool.render(entry, SCENE, trial, tmp_path / "film.exr", 20).status is Status.OK
        (worker,) = pool._workers.values()
        scratch = worker._folders[0].path
        child = psutil.Process(int(next(scratch.glob("child-*")).name.removeprefix("child-")))
    psutil.wait_procs([child], timeout=10)
    assert not child.is_running() or child.status() == psutil.STATUS_ZOMBIE
    assert not scratch.exists()


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells a process that its parent died")
def test_programs_die_with_the_harness(tmp_path):
    """A harness killed by SIGKILL while a renderer that ignores SIGTERM hangs: the renderer is gone too."""
    path = described(tmp_path, fault="hangs")
    script = f"""
import sys
sys.path.insert(0, {str(Path(__file__).parent)!r})
from test_protocol import *
(entry,) = selection.methods([{str(path)!r}], [])
trial = Trial(SCENE.id, SCENE.case, SCENE.digest, entry.name, UNLUCKY, 0)
Pool(threads=1).render(entry, SCENE, trial, Path({str(tmp_path)!r}) / "film.exr", 3600)
"""
    harness = subprocess.Popen([sys.executable, "-c", script])
    program = _program_of(harness.pid)
    harness.kill()
    harness.wait()
    psutil.wait_procs([program], timeout=10)
    assert not program.is_running() or program.status() == psutil.STATUS_ZOMBIE


def _program_of(harness: int) -> psutil.Process:
    """The renderer that a harness has started, once it is there."""
    while True:
        for process in psutil.Process(harness).children(recursive=True):
            with contextlib.suppress(psutil.Error):
                if process.cmdline()[-2:] == ["lasting", "hangs"]:
                    return process
        time.sleep(0.1)


JOB = Job("job-1", SCENE.digest, {}, 64, 7, 1, FilmFile("/nowhere/film.exr", 1, 3))
GOOD = {"job": "job-1", "digest": SCENE.digest, "film": [0, 1.5, 2e-9], "samples": 64}


def read(answer: object) -> object:
    """What the harness makes of an answer, given as text or to be written as JSON."""
    return protocol.read_answer((answer if isinstance(answer, str) else json.dumps(answer)).encode(), JOB)


def test_a_good_answer():
    """Three values; the variance, half steps and seconds of what knows them."""
    rendering = read({**GOOD, "variance": [1, 2, 3], "quantization": [0, 0, 0.5], "seconds": {"compile": 2.5}})
    assert (rendering.film.tolist(), rendering.samples, rendering.seconds) == ([0, 1.5, 2e-9], 64, {"compile": 2.5})
    assert (rendering.variance.tolist(), rendering.quantization.tolist()) == ([1, 2, 3], [0, 0, 0.5])
    assert read({"job": "job-1", "digest": SCENE.digest, "unsupported": "no"}).unsupported == "no"


@pytest.mark.parametrize(("answer", "message"), [
    ({**GOOD, "job": "job-0"}, "it answered job 'job-0' and not 'job-1'"),
    ({**GOOD, "digest": "0"}, "its answer is of another scene: its digest is '0'"),
    ({**GOOD, "film": [1, 2]}, "its film has 2 values; this film has 1 rows of 3"),
    ({**GOOD, "variance": [1]}, "its variance has 1 values"),
    ({**GOOD, "film": [1, "2", 3]}, "film[1]: '2' is not a number"),
    ({**GOOD, "film": [1, True, 3]}, "film[1]: True is not a number"),
    ({**GOOD, "film": [1, None, 3]}, "film[1]: None is not a number"),
    ({**GOOD, "film": [1, 10**400, 3]}, "film: an integer is too large"),
    ({**GOOD, "film": {"path": "/etc/passwd"}}, "film: {'path': '/etc/passwd'} is not accepted; give a list of numbers"),
    ({**GOOD, "film": "/etc/passwd"}, "film: '/etc/passwd' is not accepted"),
    ({**GOOD, "samples": 0}, "samples: 0 is not accepted; give a whole number from 1"),
    ({**GOOD, "samples": 64.0}, "samples: 64.0 is not accepted"),
    ({**GOOD, "seconds": {"setup": -1}}, "seconds.setup: -1 is out of range; it must be at least 0"),
    ({**GOOD, "seconds": {"render": 1}}, "seconds.render: is not a field here; the fields are setup, compile"),
    ({**GOOD, "noise": 1}, "noise: is not a field here; the fields are job, digest, film, samples, variance"),
    ({**GOOD, "unsupported": "no"}, "film: is not a field here; the fields are job, digest, unsupported"),
    ({"job": "job-1", "digest": SCENE.digest, "unsupported": "\x1b[2J"}, r"unsupported: '\x1b[2J' is not a line of text"),
    ({key: value for key, value in GOOD.items() if key != "film"}, "film: is missing; it must be given"),
    ([GOOD], "is not a table"),
    ("7", "7 is not a table"),
    ("", "which is no JSON"),
    ("[" * 100_000, "which is no JSON"),
    (json.dumps(GOOD) + json.dumps(GOOD), "which is no JSON (Extra data"),
    (json.dumps(GOOD)[:-1] + ', "samples": 1}', "which is no JSON (a key is given twice)"),
    (json.dumps(GOOD).replace("1.5", "Infinity"), "which is no JSON (Infinity is no JSON number)"),
    ("\ufeff" + json.dumps(GOOD), "which is no JSON"),
])  # fmt: skip
def test_a_bad_answer_is_explained(answer, message):
    """What is wrong, where, and what would be right."""
    with pytest.raises(AnswerError, match=re.escape(message)):
        read(answer)


@pytest.mark.parametrize(("grid", "digest", "message"), [
    ((2, 2), SCENE.digest, "has (2, 2) rows and columns; this film has (1, 3)"),
    ((1, 3), "0" * 64, "is the film of another scene"),
])  # fmt: skip
def test_a_film_file_of_something_else(tmp_path, grid, digest, message):
    """An OpenEXR image of another size, or whose header names another scene."""
    job = replace(JOB, film=FilmFile(str(tmp_path / "film.exr"), 1, 3))
    films.write(tmp_path / "film.exr", grid, {"Y": np.ones(grid[0] * grid[1])}, {"digest": digest})
    with pytest.raises(AnswerError, match=re.escape(message)):
        protocol.read_answer(json.dumps({**GOOD, "film": "file"}).encode(), job)


def test_a_film_file(tmp_path):
    """An OpenEXR image with a variance, and nothing in its header."""
    job = replace(JOB, film=FilmFile(str(tmp_path / "film.exr"), 1, 3))
    films.write(tmp_path / "film.exr", (1, 3), {"Y": np.array([1.0, 0.1, 2.0]), "variance": np.array([0.5, 0.25, 0])}, {})
    rendering = protocol.read_answer(json.dumps({**GOOD, "film": "file"}).encode(), job)
    np.testing.assert_allclose(rendering.film, [1, 0.1, 2])
    np.testing.assert_array_equal(rendering.variance, [0.5, 0.25, 0])


VALID = 'name = "mine"\ncommand = ["./mine"]\nversion = ["./mine", "--version"]\n'


@pytest.mark.parametrize(("text", "message"), [
    (VALID + "colour = 1", "colour: is not a field here; the fields are name, command, version, mode"),
    (VALID + "[supports]\nspectra = []", "supports.spectra: is not a field here; the fields are quantities, films, lights"),
    (VALID + "[supports]\nlights = ['laser']", "supports.lights[0]: 'laser' is not accepted; give one of 'area', 'point'"),
    (VALID + "[supports]\nlights = 'area'", "supports.lights: 'area' is not accepted; give a list"),
    (VALID + "[supports]\nreflections = -1", "supports.reflections: -1 is not accepted; give a whole number from 0"),
    (VALID + 'mode = "twice"', "mode: 'twice' is not accepted; give one of 'once', 'lasting'"),
    (VALID + "deterministic = 1", "deterministic: 1 is not accepted; give true or false"),
    (VALID.replace('"mine"', '"<b>mine</b>"'), "name: '<b>mine</b>' is not an id; give lower-case words joined by hyphens"),
    (VALID.replace('"mine"', r'"\u001b[31mmine"'), r"name: '\x1b[31mmine' is not an id"),
    (VALID.replace('["./mine"]', '"./mine; rm -rf /"'), "command: './mine; rm -rf /' is not accepted; give a list of at least 1"),
    (VALID.replace('["./mine"]', "[]"), "command: [] is not accepted; give a list of at least 1"),
    (VALID.replace('["./mine"]', '["/usr/bin/mine"]'), "command[0]: '/usr/bin/mine' is not accepted; give the name of a program"),
    (VALID.replace('["./mine"]', '["build/../../mine"]'), "command[0]: 'build/../../mine' is not accepted"),
    (VALID.replace('["./mine"]', r'["./mine", "a\u0000b"]'), r"command[1]: 'a\x00b' is not a line of text"),
    ('name = "mine"', "command: is missing; it must be given"),
    ("name = ", "is not TOML"),
    ("#" * (1 << 20) + "\n", "a manifest is a small text"),
])  # fmt: skip
def test_a_bad_manifest_is_explained(tmp_path, capsys, text, message):
    """Before anything runs: the file, the field and what would be right; exit 2."""
    path = tmp_path / "mine.toml"
    path.write_text(text)
    assert main(["run", "point-light", "--with", str(path)]) == 2
    printed = capsys.readouterr().err
    assert message in printed and str(path) in printed
    assert "Traceback" not in printed


@pytest.mark.parametrize(("command", "message"), [
    ("./mine", "there is no executable ./mine in {folder}: build it there"),
    ("no-such-renderer", "there is no executable no-such-renderer on the PATH: install it"),
])  # fmt: skip
def test_a_program_that_is_not_there(tmp_path, command, message):
    """Beside the manifest or on the PATH: what to do."""
    (tmp_path / "mine.toml").write_text(VALID.replace("./mine", command))
    (entry,) = selection.methods([str(tmp_path / "mine.toml")], [])
    with Pool(threads=1) as pool, pytest.raises(Unavailable, match=re.escape(message.format(folder=tmp_path))):
        pool.open(entry)


def test_a_manifest_of_our_own_name(tmp_path, capsys):
    """A renderer that calls itself mitsuba: refused, as nobody could tell the two apart."""
    (tmp_path / "mine.toml").write_text(VALID.replace('"mine"', '"mitsuba"'))
    assert main(["doctor", str(tmp_path / "mine.toml")]) == 2
    assert "'mitsuba' is a method of Lightproof's own; give the renderer another name" in capsys.readouterr().err


@pytest.mark.parametrize(("supports", "scene", "lacks"), [
    ({"quantities": ["irradiance"]}, "square-light-seen",
     "the quantities that its manifest supports are irradiance; this scene has radiance"),
    ({"films": ["camera"]}, "square-light", "the films that its manifest supports are camera; this scene has plane"),
    ({"lights": ["area"]}, "two-lights", None),
    ({"lights": ["area"]}, "overcast-sky", "the lights that its manifest supports are area; this scene has overcast-sky"),
    ({"lights": ["area"]}, "sphere-furnace", "the lights that its manifest supports are area; this scene has glowing-surface"),
    ({"shapes": ["polygon"]}, "disk-blocker", "the shapes that its manifest supports are polygon; this scene has disk"),
    ({"reflections": 3}, "sphere-furnace", "its manifest supports at most 3 reflections, and this scene has all"),
    ({"reflections": 3}, "sphere-furnace:five-reflections", "its manifest supports at most 3 reflections, and this scene has 5"),
    ({"reflections": 3}, "soft-shadow-picture", None),
    ({"reflections": 0}, "square-light", None),
    ({}, "sphere-furnace", None),
])  # fmt: skip
def test_what_a_manifest_supports(supports, scene, lacks):
    """A scene that needs more is not sent; the reason names what."""
    assert manifest.Supports(**supports).lacks(SUITE.scene(scene)) == lacks


def test_a_run_with_a_renderer_outside(tmp_path, capsys):
    """point-light with an honest renderer: a pass, its version and command in the record."""
    path = described(tmp_path, more='[supports]\nlights = ["point"]\n')
    options = ["--out", str(tmp_path / "runs"), "--threads", "1", "--budget", "20"]
    assert main(["run", "point-light", "square-light", "--with", str(path), *options]) == 0
    assert "1 pass, 1 unsupported" in capsys.readouterr().out
    record = store.open(next((tmp_path / "runs").glob("*")))
    assert record.run.versions["none-lasting"] == "outside 1.0"
    assert record.results()[0].settings["command"] == ["python3", str(RENDERER), "lasting", "none"]


def test_the_shipped_schema_is_that_of_the_types():
    """examples/protocol.schema.json; write it anew with python -m lightproof.renderers.schema > examples/protocol.schema.json"""
    assert json.loads((EXAMPLES / "protocol.schema.json").read_text()) == schema.whole()


SCHEMA = jsonschema.Draft202012Validator(schema.whole())


def test_every_scene_is_a_job_of_the_schema():
    """Each base case of the suite: valid as a job; with a light of an unknown kind, not."""
    for scene in filter(lambda scene: scene.case == scene_file.BASE, SUITE.scenes()):
        table = {"id": scene.id, "case": scene.case, **scene.to_table()}
        job = json.loads(json.dumps(replace(JOB, digest=scene.digest, scene=table).to_table()))
        SCHEMA.validate(job)
        job["scene"]["light"].append({"kind": "laser", "id": "laser"})
        assert not SCHEMA.is_valid(job)


@pytest.mark.parametrize(("changes", "valid"), [
    ({}, True), ({"variance": [1, 2, 3]}, True), ({"film": "file"}, True), ({"seconds": {"setup": 0.1}}, True),
    ({"film": ["1"]}, False), ({"samples": 0}, False), ({"noise": 1}, False), ({"seconds": {"render": 1}}, False),
    ({"film": [-1]}, False), ({"unsupported": "no"}, False),
])  # fmt: skip
def test_the_schema_of_an_answer(changes, valid):
    """What the harness takes, and what it refuses."""
    assert SCHEMA.is_valid({**GOOD, **changes}) is valid


def test_the_examples_on_the_page_are_valid():
    """Every job, answer and manifest in examples/README.md is one by the schema, and its scene by Lightproof's own reader."""
    page = (EXAMPLES / "README.md").read_text()
    (job,) = map(json.loads, re.findall(r"```json\n(\{\"protocol\".*?)```", page, re.DOTALL))
    SCHEMA.validate(job)
    scene_file.from_table({key: value for key, value in job["scene"].items() if key not in ("id", "case")}, job["scene"]["id"])
    answers = [json.loads(line) for line in re.findall(r"^\{\"job\".*\}$", page, re.MULTILINE)]
    assert len(answers) == 2
    for answer in answers:
        SCHEMA.validate(answer)
    for name, definition in schema.whole()["$defs"].items():
        for field in definition.get("properties", ()):
            assert f"`{field}`" in page or f'"{field}"' in page, f"{name}.{field} is not on the page"
