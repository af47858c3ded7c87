"""The command line, as a person or a script meets it: messages, exit statuses, runs that survive."""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from misbehaving import light

from lightproof import store, suite
from lightproof.cli import main, selection
from lightproof.cli.run import exit_status
from lightproof.cli.status import UsageError
from lightproof.renderers.registry import METHODS
from lightproof.suite import Suite
from lightproof.trial import Status
from lightproof.verdict import Outcome

MISBEHAVING = str(Path(__file__).with_name("misbehaving.py"))
HONEST = f"{MISBEHAVING}:Misbehaving"
AMPLE = ("--budget", "600", "--cell-budget", "300")


@pytest.fixture
def root(tmp_path) -> Path:
    """A suite with one scene, a point light above a floor, and its light as tests/misbehaving.py knows it."""
    scenes, references = tmp_path / "suite/scenes", tmp_path / "suite/references"
    scenes.mkdir(parents=True)
    references.mkdir()
    shutil.copy(suite.default().root / "scenes/point-light.toml", scenes)
    scene = Suite(tmp_path / "suite").scene("point-light")
    rows = [f"base,{element},{value!r},0.0" for element, value in enumerate(light(scene).tolist())]
    (references / "point-light.csv").write_text("\n".join(["case,element,value,uncertainty", *rows]) + "\n")
    about = {"scene_digest": scene.digest, "engine": "this test", "second_engine": "none", "agreement": 0.0, "kind": "enclosure",
             "uncertainty": 0.0, "elements_checked": 0}  # fmt: skip
    case = "\n".join(f"{key} = {json.dumps(value)}" for key, value in about.items())
    head = 'formula = "E = I cos / r2"\nsource = "the inverse square"\ncitations = []\n'
    (references / "point-light.toml").write_text(f"{head}\n[cases.base]\n{case}\n")
    return tmp_path / "suite"


@pytest.fixture
def command(root, tmp_path, capsys):
    """`lightproof run` on that suite: exit status, output, errors and the record."""

    def command(*arguments: str, methods=(HONEST,)):
        out = tmp_path / "runs"
        before = set(out.glob("*"))
        status = main(["run", *arguments, "--suite", str(root), "--out", str(out), "--threads", "1", "--with", *methods])
        printed = capsys.readouterr()
        new = set(out.glob("*")) - before
        return status, printed.out, printed.err, store.open(new.pop()) if new else None

    return command


def test_an_honest_renderer_passes(command):
    """Point light with unbiased noise of 1 / sqrt(samples): a pass, 16 films a step, exit 0 even where a pass is demanded."""
    status, out, _, record = command("--strict")
    assert (status, "1 pass" in out, str(record.folder) in out) == (0, True, True)
    results = record.results()
    assert len(results) % 16 == 0 and {result.status for result in results} == {Status.OK}
    assert record.run.versions["misbehaving:Misbehaving"] == "1.0"
    assert record.run.threads == 1


def test_faults_leave_the_rest_of_a_run_unharmed(command):
    """An honest renderer among five that fail: each failure is named, exit 3, and its films are those of a run of its own."""
    faults = ("raises", "segfaults", "exits-at-once", "negative", "not-installed")
    status, out, _, record = command(methods=[HONEST, *(f"{HONEST}/{fault}" for fault in faults)])
    assert status == 3
    assert "1 pass, 1 unsupported, 4 error" in out
    for fault in faults:
        assert f"misbehaving:Misbehaving/{fault}" in out
    assert "pip install 'lightproof[misbehaving]'" in out
    alone = films_of(command()[-1].folder)
    assert {key: film for key, film in films_of(record.folder).items() if key in alone} == alone
    counts = [sum(result.trial.method == f"misbehaving:Misbehaving/{fault}" for result in record.results()) for fault in faults]
    assert counts == [1] * 5


def test_a_missing_renderer_is_no_pass(command):
    """A renderer that is not installed beside one that passes: the run is done, but --strict wants every verdict."""
    methods = [HONEST, f"{HONEST}/not-installed"]
    assert [command(*strict, methods=methods)[0] for strict in ((), ("--strict",))] == [0, 3]


@pytest.mark.parametrize("fault", ["identical", "ignores-seed"])
def test_replicates_that_are_none_are_noticed(command, fault):
    """Every film the same: exact light is a pass as of a deterministic method; noise that ignores the seed never is."""
    status, out, _, _ = command("--strict", methods=[f"{HONEST}/{fault}"])
    assert (status == 0, "1 pass" in out) == (fault == "identical",) * 2


def lightproof(*arguments: object, **options) -> subprocess.Popen:
    """The command in a process of its own, which heeds an interrupt even where the tests run in the background, deaf to it."""
    command = [sys.executable, "-m", "lightproof.cli", *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL), **options)


def lines_of(path: Path) -> int:
    return path.read_bytes().count(b"\n")


def wait_for(condition) -> None:
    """Wait until something happens; a test that hangs here has failed."""
    while not condition():
        time.sleep(0.02)


def interrupted(root: Path, out: Path, number: signal.Signals) -> tuple[int, str, Path]:
    """Exit status, output and folder of a run that gets a signal once 20 trials are recorded."""
    running = lightproof("run", "--suite", root, "--out", out, "--threads", 1, *AMPLE, "--with", f"{HONEST}/slow", HONEST)
    wait_for(lambda: running.poll() is not None or any(lines_of(path) >= 20 for path in out.glob("*/trials.jsonl")))
    running.send_signal(number)
    output, _ = running.communicate()
    return running.returncode, output, next(out.iterdir())


def films_of(folder: Path) -> dict[str, bytes]:
    """Every recorded film, by the trial's key."""
    results = [result for result in store.open(folder).results() if result.film is not None]
    films = {result.trial.key: result.film.tobytes() for result in results}
    assert len(films) == len(results)
    return films


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_a_run_survives_its_end(root, tmp_path, command, number):
    """Killed or interrupted in the middle, then resumed: the same films as a run that was left alone."""
    _, _, _, whole = command(*AMPLE, methods=[f"{HONEST}/slow", HONEST])
    status, output, folder = interrupted(root, tmp_path / "cut", number)
    if number == signal.SIGINT:
        assert status == 3
        assert f"lightproof run --resume {folder}" in output
    before = films_of(folder)
    assert len(before) >= 20
    assert main(["run", "--resume", str(folder)]) == 0
    after = films_of(folder)
    assert {key: after[key] for key in before} == before
    assert after == films_of(whole.folder)


def test_a_resumed_run_keeps_its_plan(command, capsys):
    """--resume with another budget: refused, and told what to leave out."""
    *_, record = command()
    assert main(["run", "--resume", str(record.folder), "--budget", "5"]) == 2
    assert "leave out budget" in capsys.readouterr().err


@pytest.mark.parametrize(("arguments", "message"), [
    (["run", "sqare-light"], "there is no scene 'sqare-light'; did you mean square-light"),
    (["run", "square-light:fra"], "there is no case 'fra'; the cases are base, near, far"),
    (["run", "--with", "mitsba"], "there is no method 'mitsba'; did you mean mitsuba"),
    (["run", "--with", "xyz*"], "there is no method 'xyz*'; there are analytic, "),
    (["run", "--with", "cycles/lmap"], "there is no method 'cycles/lmap'; did you mean cycles/lamp"),
    (["run", "--with", "nowhere.py:Renderer"], "nowhere.py: there is no such file"),
    (["run", "--with", "renderer.py"], "renderer.py: name the function or class too, such as renderer.py:render"),
    (["run", "--tags", "shadows"], "there is no tag 'shadows'; did you mean shadow"),
    (["run", "nowhere.toml"], "nowhere.toml: cannot be read"),
    (["run", "--suite", "/nowhere"], "/nowhere: is no suite"),
    (["run", "--out", "/dev/null/runs"], "/dev/null/runs: cannot be written"),
    (["run", "--resume", "/nowhere"], "/nowhere: is no run"),
    (["run", "point-light", "--tags", "furnace"], "no scene carries the tag furnace"),
    (["report", "/nowhere"], "/nowhere: is no run"),
    (["list", "--suite", "/nowhere"], "/nowhere: is no suite"),
    (["doctor", "mitsba"], "there is no method 'mitsba'"),
    (["certify"], "there is nothing to certify"),
    (["certify", "sqare-light"], "there is no scene 'sqare-light'; did you mean square-light"),
    (["certify", "nowhere.toml"], "nowhere.toml: cannot be read"),
])  # fmt: skip
def test_bad_input_is_explained(capsys, arguments, message):
    """What is wrong, where, and what would be right; exit 2; nothing has run."""
    assert main(arguments) == 2
    printed = capsys.readouterr()
    assert message in printed.err
    assert "Traceback" not in printed.err


@pytest.mark.parametrize("arguments", [
    [], ["rnu"], ["run", "--budget", "0"], ["run", "--budget", "nan"], ["run", "--budget", "soon"], ["run", "--replicates", "1"],
    ["run", "--threads", "0"], ["run", "--seed", "-1"], ["run", "--cell-budget", "-3"],
])  # fmt: skip
def test_bad_numbers_are_explained(capsys, arguments):
    """A budget of no seconds, one replicate, no threads: exit 2 with the usage."""
    with pytest.raises(SystemExit) as exit:
        main(arguments)
    assert exit.value.code == 2
    assert "usage: lightproof" in capsys.readouterr().err


def test_a_broken_scene_stops_a_run_before_it_starts(command, tmp_path):
    """A user's scene with a negative intensity beside a good one: named with file and field, and no run is made."""
    broken = tmp_path / "suite/scenes/broken.toml"
    broken.write_text((tmp_path / "suite/scenes/point-light.toml").read_text().replace("intensity = 2.9", "intensity = -2.9"))
    status, _, err, record = command("point-light", str(broken))
    assert (status, record) == (2, None)
    assert "broken.toml" in err and "light.bulb.intensity" in err and "at least 0" in err


def test_a_users_scene_is_judged_by_its_own_suite(root, tmp_path, capsys):
    """The path of a scene file: run with the default suite elsewhere, and judged by the references beside it."""
    path = root / "scenes/point-light.toml"
    assert main(["run", str(path), "--with", HONEST, "--out", str(tmp_path / "runs"), "--threads", "1"]) == 0
    assert "1 pass" in capsys.readouterr().out


def test_a_page_that_cannot_be_written_is_explained(command, capsys):
    """A folder in the place of results.csv: its path, exit 2."""
    *_, record = command()
    (record.folder / "results.csv").mkdir()
    assert main(["report", str(record.folder)]) == 2
    assert "results.csv: cannot be written" in capsys.readouterr().err


def test_two_scenes_of_one_name_are_refused(root):
    """A user's point-light beside the suite's, and different from it: refused."""
    path = root / "scenes/point-light.toml"
    path.write_text(path.read_text().replace("intensity = 2.9", "intensity = 3.1"))
    with pytest.raises(UsageError, match="two different scenes are called point-light"):
        selection.scenes(["point-light", str(path)], [], suite.default())


def test_the_default_selection():
    """Without arguments: the base case of every quick scene, and each renderer's best configuration."""
    home = suite.default()
    quick = [scene_id for scene_id in home.ids if "quick" in home.scene(scene_id).tags]
    assert "square-light" in quick and len(quick) < len(home.ids)
    assert [scene.name for scene in selection.scenes([], [], home)] == quick
    assert [entry.name for entry in selection.methods([], [])] == [entry.name for entry in METHODS.values() if not entry.nightly]


def test_the_nightly_selection():
    """The tag nightly: every case of every scene, and every configuration; with another tag: every case that carries it."""
    home = suite.default()
    assert list(selection.scenes([], ["nightly"], home)) == home.scenes()
    assert selection.methods([], ["nightly"]) == list(METHODS.values())
    shadows = list(selection.scenes([], ["nightly", "shadow"], home))
    assert shadows == [scene for scene in home.scenes() if "shadow" in scene.tags] != []


def test_methods_by_glob():
    """mitsuba*: every configuration of Mitsuba; a name twice counts once."""
    chosen = [entry.name for entry in selection.methods(["mitsuba*", "mitsuba"], [])]
    assert chosen == [name for name in METHODS if name.startswith("mitsuba")]
    assert {"mitsuba", "mitsuba/scalar", "mitsuba/sobol"} <= set(chosen)


@pytest.mark.parametrize(("outcomes", "relaxed", "strict"), [
    ([Outcome.PASS, Outcome.UNSUPPORTED], 0, 0),
    ([Outcome.PASS, Outcome.UNDECIDED], 0, 3),
    ([Outcome.PASS, Outcome.NO_REFERENCE], 0, 3),
    ([Outcome.FAIL, Outcome.UNDECIDED], 0, 1),
    ([Outcome.FAIL, Outcome.ERROR], 3, 1),
    ([Outcome.PASS, Outcome.ERROR], 3, 3),
])  # fmt: skip
def test_exit_statuses(outcomes, relaxed, strict):
    """Verdicts do not fail a job that was done; errors do; --strict asks for passes."""
    assert exit_status(outcomes, strict=False, complete=True) == relaxed
    assert exit_status(outcomes, strict=True, complete=True) == strict
    assert exit_status(outcomes, strict=True, complete=False) == (strict or 3)


def test_certify_keeps_and_checks(root, capsys):
    """A point light: its reference written beside it and found again; wrong values are told, and so is
    a scene that has changed since."""
    stored = root / "references/point-light.csv"
    assert main(["certify", "point-light", "--suite", str(root)]) == 0
    assert "point-light:tilted: certify/direct within" in capsys.readouterr().out
    assert main(["certify", str(root / "scenes/point-light.toml"), "--check"]) == 0
    assert "3 references fit their scenes, an element of 3 computed again" in capsys.readouterr().out
    honest = stored.read_text()
    stored.write_text(honest.replace(",0.", ",0.1"))
    assert main(["certify", "point-light", "--suite", str(root), "--check", "--seed", "1"]) == 1
    assert "the first engine finds" in capsys.readouterr().out
    stored.write_text(honest)
    scene = root / "scenes/point-light.toml"
    scene.write_text(scene.read_text().replace("intensity = ", "intensity = 1"))
    assert main(["certify", "--suite", str(root), "--check"]) == 1
    assert "was made for another version of the scene" in capsys.readouterr().out


def test_certify_says_what_it_cannot(root, capsys):
    """A diffuse wall beside a point light, which the first engine does not cover: the reason, exit 3, nothing written."""
    path = root / "scenes/lit-wall.toml"
    scene = (root / "scenes/point-light.toml").read_text().partition("[cases")[0].replace("max_bounces = 0", "max_bounces = 1")
    corners = "[[2, -1, 0], [2, 1, 0], [2, 1, 1], [2, -1, 1]]"
    wall = f'[[surface]]\nid = "wall"\nreflectance = 0.5\nshape = {{ type = "polygon", vertices = {corners} }}\n'
    path.write_text(scene + wall)
    assert main(["certify", str(path)]) == 3
    assert "not certified: lit-wall: " in capsys.readouterr().out
    assert not (root / "references/lit-wall.csv").exists()


def test_the_list_shows_scenes_and_methods(capsys, monkeypatch):
    """Every scene with its cases and tags, every method with what installs it."""
    monkeypatch.setenv("COLUMNS", "300")
    assert main(["list"]) == 0
    out = capsys.readouterr().out
    options = {part for method in METHODS for part in method.split("/")}
    for name in (*suite.default().ids, *options, "furnace", "pip install 'lightproof[cycles]'"):
        assert name in out


def test_the_list_is_grouped_and_filtered(capsys, monkeypatch):
    """A group a table, each scene in the group of its first tag; a tag keeps the scenes that carry it."""
    monkeypatch.setenv("COLUMNS", "300")
    assert main(["list", "--tags", "furnace"]) == 0
    out = capsys.readouterr().out
    assert "Scenes: furnace" in out and "sphere-furnace" in out
    assert "Scenes: direct" not in out and "square-light" not in out
    assert main(["list", "--tags", "furnaces"]) == 2


def test_the_doctor_tries_a_renderer(capsys):
    """An honest renderer of point lights: its version and mean; one that is not installed: the command; a broken one: exit 3."""
    assert main(["doctor", HONEST, f"{HONEST}/not-installed"]) == 0
    out = capsys.readouterr().out
    assert "misbehaving:Misbehaving 1.0: rendered point-light at 64 samples" in out
    assert "misbehaving:Misbehaving/not-installed is not there: pip install 'lightproof[misbehaving]'" in out
    assert main(["doctor", f"{HONEST}/raises"]) == 3
    assert "out of photons" in capsys.readouterr().out
