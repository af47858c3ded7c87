"""Units as they are measured: the power of a light in a black box, kept for each version; a step between versions is an alarm."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lightproof import cli, store, suite
from lightproof.films import write as write_film
from lightproof.reporting import page, units
from lightproof.reporting.evaluation import Evaluation, evaluate
from lightproof.store import Run
from lightproof.trial import Result, Status, Trial

HOME = suite.default()
POINTS = [scene for scene in HOME.cases(units.SCENE).values() if units.light_of(scene) == "point"]
STARTED = "2026-01-02T03:04:05+00:00"


def run_of(folder: Path, factor: float, scenes=POINTS, noise: float = 1e-3, started: str = STARTED, version="1.0") -> Evaluation:
    """A run of a renderer that is too bright by a factor, with noise, on the walls of `scenes`."""
    run = Run(f"run-{version}", started, "digest", "a machine", 2, 7, {"mine": version}, "", {"budget": 1.0})
    record, random = store.create(folder, run, scenes), np.random.default_rng(1)
    for scene in scenes:
        exact = HOME.reference(scene).value
        for replicate in range(16):
            trial = Trial(scene.id, scene.case, scene.digest, "mine", 64, replicate)
            film = factor * exact * (1 + noise * random.normal(size=exact.shape))
            path = record.film_path(trial)
            path.parent.mkdir(parents=True, exist_ok=True)
            write_film(path, (1, len(film)), {"Y": film}, {})
            record.append(Result(trial, Status.OK, film=film, samples=64, version=version, seconds={"render": 1.0}))
    return evaluate(store.open(record.folder), HOME)


def test_a_factor_is_the_power_of_all_walls_over_the_true_one(tmp_path):
    """A renderer that takes power for 4 pi / 3.7 of an intensity: its factor, with an interval as wide as the noise is."""
    (found,) = units.measure(run_of(tmp_path, 3.7))
    assert (found.method, found.version, found.light) == ("mine", "1.0", "point")
    assert found.low < 3.7 < found.high
    assert 1e-5 < (found.high - found.low) / 3.7 < 1e-3


def test_a_box_with_a_wall_missing_tells_nothing(tmp_path):
    """Five of six walls."""
    assert units.measure(run_of(tmp_path, 1.0, POINTS[:5])) == []


def test_factors_are_kept_and_none_is_replaced(tmp_path):
    """Two versions and one of them again: every row stays, and what is read is what was kept, to the last bit."""
    first, second = (units.measure(run_of(tmp_path / name, 1.0, version=name)) for name in ("1.0", "2.0"))
    for factors in (first, second, first):
        units.keep(tmp_path / "kept.csv", factors)
    assert units.read(tmp_path / "kept.csv") == [*first, *second]


def test_a_broken_file_is_named(tmp_path):
    (tmp_path / "kept.csv").write_text("method,version\nmitsuba,3\n")
    with pytest.raises(units.UnitsError, match="is no file of factors"):
        units.read(tmp_path / "kept.csv")


@pytest.mark.parametrize(("factor", "alarming"), [(1.02, True), (0.98, True), (1.0, False)])
def test_a_step_between_versions_is_an_alarm(tmp_path, factor, alarming):
    """By two per cent, when noise leaves a thousandth; the page says it, and shows both factors raw."""
    before = units.measure(run_of(tmp_path / "old", 1.0, version="1.0"))
    later = run_of(tmp_path / "new", factor, version="2.0", started="2026-02-02T03:04:05+00:00")
    factors = [*before, *units.measure(later)]
    assert bool(units.alarms(factors, units.current(factors, {"mine": "2.0"}))) == alarming
    html = page.render(later, {}, lambda scene: (_ for _ in ()).throw(OSError("no picture")), factors)
    assert ("times as bright in 2.0 as in 1.0" in html) == alarming
    assert units.shown(units.current(factors, {"mine": "2.0"})[0]) in html


def test_the_last_digit_is_no_alarm(tmp_path):
    """A renderer without noise, whose interval has no width, adds up in another order."""
    first = replace(units.measure(run_of(tmp_path, 1.0))[0], factor=1.0, low=1.0, high=1.0)
    for factor, alarming in ((1 + 1e-8, False), (1 + 1e-4, True)):
        later = replace(first, version="2.0", factor=factor, low=factor, high=factor, started="2026-02-02T03:04:05+00:00")
        assert bool(units.alarms([first, later], [later])) == alarming


def test_a_broken_file_is_told_before_anything_is_rendered(tmp_path, monkeypatch, capsys):
    """By every command that reads it."""
    monkeypatch.chdir(tmp_path)
    units.FILE.parent.mkdir()
    units.FILE.write_text("garbage")
    evaluation = run_of(tmp_path, 1.0)
    for command in (["calibrate", "mc-area"], ["report", evaluation.run.id]):
        assert cli.main(command) == 2
        assert "is no file of factors" in capsys.readouterr().err
    assert not (tmp_path / "reports" / "runs").exists()


def test_an_older_version_is_no_alarm_for_itself(tmp_path):
    """Of two versions that differ, the one measured first is not told that it has changed."""
    first = units.measure(run_of(tmp_path, 1.0))[0]
    later = replace(first, version="2.0", factor=1.1, low=1.09, high=1.11, started="2026-02-02T03:04:05+00:00")
    assert units.alarms([first, later], [first]) == []
    assert len(units.alarms([first, later], [later])) == 1
