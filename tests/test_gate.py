"""The gate: what is worse than the baseline fails, what is as good passes, and only a person changes the baseline."""

from __future__ import annotations

import math
import shutil
import subprocess
import sys
from dataclasses import replace

import pytest

from lightproof import baseline, gate, suite
from lightproof.baseline import BaselineError, State
from lightproof.cli import checkup, main
from lightproof.cli import gate as command
from lightproof.gate import Gate

GOOD = State("point-light", "base", "mc-area", "pass", 64, 6e-4, 0.03, 16)


@pytest.mark.parametrize("outcome", ["fail", "undecided", "unsupported", "error", "no-reference"])
def test_any_other_outcome_is_worse_than_a_pass(outcome):
    assert gate.compare(replace(GOOD, outcome=outcome), GOOD).message.startswith("mc-area on point-light: ")


def test_the_same_and_the_better_are_not_worse():
    assert gate.compare(GOOD, GOOD) is None
    assert gate.compare(GOOD, replace(GOOD, outcome="undecided")) is None
    assert gate.compare(replace(GOOD, variance_per_sample=1e-5), GOOD) is None


def test_a_fail_is_worse_even_where_the_baseline_failed():
    failing = replace(GOOD, outcome="fail")
    assert gate.compare(failing, failing).message.endswith("fails")


def test_more_variance_than_the_interval_allows_is_noisier():
    """Errors of 3 % in the logarithm each: 1.1 times is chance, 1.5 times is not."""
    assert gate.compare(replace(GOOD, variance_per_sample=6.6e-4), GOOD) is None
    finding = gate.compare(replace(GOOD, variance_per_sample=9e-4), GOOD)
    assert finding.noisier and "1.50 times" in finding.message


def test_a_method_without_noise_has_no_variance_to_compare():
    exact = replace(GOOD, method="analytic", variance_per_sample=0.0, log_error=0.0, replicates=0)
    assert gate.compare(exact, exact) is None
    assert not math.isnan(exact.variance_per_sample)


def test_a_baseline_reads_back_as_it_was_written(tmp_path):
    path = tmp_path / "baseline.csv"
    path.write_text(baseline.to_csv([GOOD]))
    assert baseline.read(path) == {GOOD.key: GOOD}


@pytest.mark.parametrize("text", ["", "scene,case\na,b\n", "nonsense", "scene,case,method,outcome,samples,variance_per_sample,"
                                  "log_error,replicates\na,b,c,great,64,1,1,16\n"])
def test_a_broken_baseline_says_so(tmp_path, text, capsys):
    path = tmp_path / "baseline.csv"
    path.write_text(text)
    with pytest.raises(BaselineError, match=r"baseline\.csv"):
        baseline.read(path)
    assert main(["gate", "--baseline", str(path), "--out", str(tmp_path)]) == 2
    assert "baseline.csv" in capsys.readouterr().err


def test_a_missing_baseline_says_how_to_make_one(tmp_path, capsys):
    assert main(["gate", "--baseline", str(tmp_path / "none.csv"), "--out", str(tmp_path)]) == 2
    assert "gate --run" in capsys.readouterr().err


@pytest.fixture(scope="module", autouse=True)
def checkup_of_the_suite():
    """Left out here, but where a test asks for it: it takes some seconds each time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(command, "checkup", lambda scenes: checkup.Checkup((), 0, 0, 0))
        yield


@pytest.fixture(scope="module")
def accepted(tmp_path_factory):
    """Point light by mc-area and analytic, measured, judged, and accepted."""
    folder = tmp_path_factory.mktemp("accepted")
    runs, state = str(folder / "runs"), folder / "state"
    assert main(["run", "point-light", "--with", "mc-area", "analytic", "--budget", "30", "--out", runs]) == 0
    (run,) = (folder / "runs").iterdir()
    assert main(["gate", "--run", str(run), "--baseline", str(folder / "baseline.csv"), "--out", str(state)]) == 0
    (folder / "baseline.csv").write_bytes((state / "baseline.csv").read_bytes())
    return folder / "baseline.csv"


def test_nothing_changed_passes_and_leaves_the_baseline_alone(accepted, tmp_path, capsys):
    before = accepted.read_bytes()
    assert main(["gate", "--baseline", str(accepted), "--out", str(tmp_path)]) == 0
    assert accepted.read_bytes() == before
    assert (tmp_path / "baseline.diff").read_text() == ""
    assert "0 worse" in capsys.readouterr().out


def test_a_stale_reference_fails_the_gate(accepted, tmp_path, monkeypatch, capsys):
    """Every row is as good as the baseline, but another scene has changed since its reference was made."""
    monkeypatch.setattr(command, "checkup", checkup.checkup)
    root = tmp_path / "suite"
    for folder, suffixes in (("scenes", ("toml",)), ("references", ("csv", "toml"))):
        (root / folder).mkdir(parents=True)
        for name in ("point-light", "knife-edge"):
            for suffix in suffixes:
                shutil.copy(suite.default().root / folder / f"{name}.{suffix}", root / folder)
    changed = root / "scenes/knife-edge.toml"
    changed.write_text(changed.read_text().replace("radiance = ", "radiance = 1"))
    assert main(["gate", "--baseline", str(accepted), "--suite", str(root), "--out", str(tmp_path / "state")]) == 1
    out = capsys.readouterr().out
    assert "knife-edge.toml: the reference of case 'base' was made for another version" in out and " 0 worse" in out


def test_a_noisier_method_fails_and_the_difference_is_written(accepted, tmp_path, capsys):
    """The accepted variance is a tenth of the true one: both draws see ten times as much."""
    rows = baseline.read(accepted)
    noisy = rows["point-light", "base", "mc-area"]
    rows[noisy.key] = replace(noisy, variance_per_sample=noisy.variance_per_sample / 10)
    file = tmp_path / "baseline.csv"
    file.write_text(baseline.to_csv(rows.values()))
    assert main(["gate", "--baseline", str(file), "--out", str(tmp_path / "state"), "--with", "mc-area"]) == 1
    assert "variance per sample" in capsys.readouterr().out
    assert "+point-light,base,mc-area" in (tmp_path / "state" / "baseline.diff").read_text()


def test_noise_that_a_second_draw_does_not_confirm_is_no_finding(accepted, tmp_path, monkeypatch):
    """The first draw is looked at through a lens of ten times its variance, the second as it is."""
    observe = gate.observe_run
    lens = iter([10.0, 1.0])

    def observed(record, rows):
        factor = next(lens)
        return [replace(state, variance_per_sample=state.variance_per_sample * factor) for state in observe(record, rows)]

    monkeypatch.setattr(gate, "observe_run", observed)
    rows = baseline.select(baseline.read(accepted), methods=["mc-area"])
    report = Gate(suite.default(), tmp_path, 1).check(rows)
    assert report.exit_status == 0 and next(lens, None) is None


def test_a_method_that_is_not_there_is_incomplete(accepted, tmp_path, capsys):
    rows = [*baseline.read(accepted).values(), replace(GOOD, method="lost-renderer")]
    file = tmp_path / "baseline.csv"
    file.write_text(baseline.to_csv(rows))
    assert main(["gate", "--baseline", str(file), "--out", str(tmp_path / "state")]) == 3
    assert "lost-renderer" in capsys.readouterr().out


def test_a_run_without_some_accepted_rows_is_incomplete(accepted, tmp_path, capsys):
    """A run of one method, judged by a baseline that knows two."""
    runs = tmp_path / "runs"
    assert main(["run", "point-light", "--with", "analytic", "--budget", "30", "--out", str(runs)]) == 0
    (run,) = runs.iterdir()
    assert main(["gate", "--run", str(run), "--baseline", str(accepted), "--out", str(tmp_path / "state")]) == 3
    assert "mc-area on point-light: the run has no result of it" in capsys.readouterr().out


PLUGIN_TEST = """
import pytest

@pytest.mark.lightproof_gate(scenes=["point-light"], methods=["analytic"], baseline="baseline.csv")
def test_light():
    pass
"""


def test_the_marker_judges_before_the_body(accepted, tmp_path):
    """With the accepted rows the test passes; with a baseline that has no such row it cannot."""
    (tmp_path / "test_example.py").write_text(PLUGIN_TEST)
    (tmp_path / "baseline.csv").write_bytes(accepted.read_bytes())
    assert "1 passed" in run_pytest(tmp_path)
    (tmp_path / "baseline.csv").write_text(baseline.to_csv([]))
    assert "has no row" in run_pytest(tmp_path)


def run_pytest(folder):
    return subprocess.run([sys.executable, "-m", "pytest", "-q"], cwd=folder, capture_output=True, text=True).stdout
