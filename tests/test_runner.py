"""The ladder, the budget and the order of steps, with a pool whose costs are known: no clock, no process."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import pytest
from test_store import RUN, SCENES, trial

from lightproof import store, suite
from lightproof.estimators.options import SAMPLING
from lightproof.renderers.registry import Entry
from lightproof.runner import Cell, Decision, Progress, Runner
from lightproof.trial import PRECISIONS, Result, Status, Trial

SCENE = suite.default().scene("point-light")
REPLICATES = 4


@dataclass
class FakePool:
    """Renders in no time and charges `cost` (method -> seconds per sample); `setup` [s] with every preparation."""

    cost: dict[str, float]
    deterministic: bool = False
    setup: float = 0.0
    status: Callable[[Trial], Status] = lambda trial: Status.OK
    asked: list[Trial] = field(default_factory=list)
    timeouts: list[float] = field(default_factory=list)

    def render(self, entry, scene, trial, film, timeout) -> Result:
        self.asked.append(trial)
        self.timeouts.append(timeout)
        seconds = {"setup": self.setup, "compile": 50 * self.setup, "render": self.cost[entry.name] * trial.samples}
        return Result(trial, self.status(trial), samples=trial.samples, seconds=seconds, deterministic=self.deterministic)


def climb(tmp_path, pool: FakePool, decide: Callable[[Sequence[Result]], Decision], budget: float = 1e9, cell_budget: float = 1e9,
          told: list[Progress] | None = None, record: store.Store | None = None, **wanted: float) -> list[Cell]:
    """The cells after a run of every method of the pool on one scene."""
    cells = [Cell(SCENE, Entry(name, "x:X", worker=name), cell_budget, REPLICATES, **wanted) for name in pool.cost]
    record = record or store.create(tmp_path, RUN, SCENES)
    return Runner(cells, budget, record, pool, decide, ([] if told is None else told).append).run()


def decided_at(samples: int) -> Callable[[Sequence[Result]], Decision]:
    """A verdict that stands from a step of `samples` on, and says so before."""
    return lambda results: Decision(max(result.trial.samples for result in results) >= samples, samples)


def undecided(results: Sequence[Result]) -> Decision:
    """A verdict that the next step may decide, but never does."""
    return Decision(False, 4 * max(result.trial.samples for result in results))


def steps(pool: FakePool) -> list[int]:
    """Samples per element of each film asked for."""
    return [trial.samples for trial in pool.asked]


def test_the_ladder(tmp_path):
    """A verdict decided at 1,024 samples: steps of 64, 256 and 1,024 with fresh replicates, the run's seed in each trial."""
    pool = FakePool({"a": 1e-6})
    climb(tmp_path, pool, decided_at(1024))
    assert steps(pool) == [64] * 4 + [256] * 4 + [1024] * 4
    assert [trial.replicate for trial in pool.asked] == [0, 1, 2, 3] * 3
    assert {trial.run_seed for trial in pool.asked} == {RUN.seed}
    assert len({trial.seed for trial in pool.asked}) == 12


def test_precisions_share_their_points():
    """Films of one method in float32 and float64 have one seed; other options, replicates and numbers of samples have others."""
    def seed(method: str, samples: int = 64, replicate: int = 0) -> int:
        return Trial("scene", "base", "digest", method, samples, replicate).seed

    assert seed("mc-area") == seed("mc-area/float64") == seed("mc-area/float32")
    assert seed("mc-area/sobol") == seed("mc-area/sobol-float64")
    assert seed("mc-area/sobol") == seed("mc-area/float64-sobol")
    assert set(PRECISIONS) == set(SAMPLING["precision"])
    others = [seed("mc-area/sobol"), seed("mc-cosine"), seed("mc-area", samples=256), seed("mc-area", replicate=1)]
    assert len({seed("mc-area"), *others}) == 5


def test_a_decided_verdict_gets_three_steps_for_its_slope(tmp_path):
    """A verdict that stands at once: two more steps, so that error against time is a line."""
    pool = FakePool({"a": 1e-6})
    climb(tmp_path, pool, decided_at(64))
    assert steps(pool) == [64] * 4 + [256] * 4 + [1024] * 4


def test_cheap_steps_are_taken_whatever_is_decided(tmp_path):
    """A verdict that stands at once, and 0.1 s to spare for a step of four films at 1e-6 s a sample: it ends at 16,384."""
    pool = FakePool({"a": 1e-6})
    climb(tmp_path, pool, decided_at(64), spare=0.1)
    assert sorted(set(steps(pool))) == [64, 256, 1024, 4096, 16384]


def test_a_slope_is_not_worth_any_price(tmp_path):
    """A verdict that stands at once: the step of 256 samples takes 1 ms, that of 1,024 takes 4 ms, more than 3 ms."""
    pool = FakePool({"a": 1e-6})
    climb(tmp_path, pool, decided_at(64), slope=0.003)
    assert sorted(set(steps(pool))) == [64, 256]


def test_the_deterministic_render_one_film_a_step(tmp_path):
    """A deterministic method decided at 4,096 samples: four films."""
    pool = FakePool({"a": 1e-6}, deterministic=True)
    climb(tmp_path, pool, decided_at(4096))
    assert steps(pool) == [64, 256, 1024, 4096]


@pytest.mark.parametrize("status", [Status.ERROR, Status.UNSUPPORTED])
def test_a_trial_that_fails_ends_its_cell_alone(tmp_path, status):
    """The second film of a method fails: that method stops, the other climbs on, everything is recorded."""

    def fails(trial: Trial) -> Status:
        return status if (trial.method, trial.replicate) == ("a", 1) else Status.OK

    pool = FakePool({"a": 1e-6, "b": 1e-6}, status=fails)
    cells = climb(tmp_path, pool, decided_at(1024))
    assert [len(cell.results) for cell in cells] == [2, 12]
    assert len(store.open(tmp_path / RUN.id).results()) == 14


def test_the_cheapest_undecided_step_comes_first(tmp_path):
    """a costs 10 times as much as b: after the first step of both, b climbs until its next step is dearer than a's."""
    pool = FakePool({"a": 1e-5, "b": 1e-6})
    climb(tmp_path, pool, decided_at(4096))
    order = [(trial.method, trial.samples) for trial in pool.asked if trial.replicate == 0]
    assert order == [("a", 64), ("b", 64), ("b", 256), ("b", 1024), ("a", 256), ("b", 4096), ("a", 1024), ("a", 4096)]


def test_verdicts_come_before_slopes(tmp_path):
    """a is decided at once and b, which costs three times as much, at 256 samples: b's verdict comes before a's second step."""
    pool = FakePool({"a": 1e-6, "b": 3e-6})
    climb(tmp_path, pool, lambda results: Decision(results[0].trial.method == "a" or results[-1].trial.samples >= 256, 256))
    order = [(trial.method, trial.samples) for trial in pool.asked if trial.replicate == 0]
    assert order == [("a", 64), ("b", 64), ("b", 256), ("a", 256), ("a", 1024), ("b", 1024)]


def test_a_cheap_slope_does_not_wait_for_a_dear_verdict(tmp_path):
    """a is decided at once and costs a hundredth of b, which is not: a has its three steps before b's second."""
    pool = FakePool({"a": 1e-6, "b": 1e-4})
    climb(tmp_path, pool, lambda results: Decision(results[0].trial.method == "a" or results[-1].trial.samples >= 256, 256))
    order = [(trial.method, trial.samples) for trial in pool.asked if trial.replicate == 0]
    assert order == [("a", 64), ("b", 64), ("a", 256), ("a", 1024), ("b", 256), ("b", 1024)]


def test_the_budget_of_the_run(tmp_path):
    """Steps cost 1, 4 and 16 s; of 10 s there is none left for the third."""
    pool = FakePool({"a": 1 / 256})
    cells = climb(tmp_path, pool, undecided, budget=10)
    assert max(steps(pool)) == 256
    assert cells[0].seconds == pytest.approx(5)


def test_the_budget_of_a_cell(tmp_path):
    """Steps of a cost 1, 4 and 16 s: of 10 s there is none left for the third; b, a thousand times cheaper, gets far."""
    pool = FakePool({"a": 1 / 256, "b": 1 / 256_000})
    a, b = climb(tmp_path, pool, undecided, cell_budget=10)
    assert (a.height, b.height) == (2, 7)
    assert a.seconds <= 10 and b.seconds <= 10


def test_set_up_counts_once_a_step_and_compiling_never(tmp_path):
    """2 s of set-up, 100 s of compiling and four films of 1 s: steps cost 6 s and 18 s, and of 30 s two are all that fits."""
    pool = FakePool({"a": 1 / 64}, setup=2)
    (cell,) = climb(tmp_path, pool, undecided, cell_budget=30)
    assert (cell.height, cell.seconds) == (2, 6 + 18)


def test_a_first_step_that_is_too_dear_is_not_finished(tmp_path):
    """Films of 64 s with 150 s to spend: two are rendered (one alone may have compiled), then the cell stops."""
    pool = FakePool({"a": 1.0})
    (cell,) = climb(tmp_path, pool, undecided, cell_budget=150)
    assert (len(cell.results), cell.height) == (2, 0)


def test_a_hopeless_verdict_gets_three_steps(tmp_path):
    """A verdict that needs a million samples, of which the cell's budget holds 16,384: three steps for the slope, no more."""
    pool = FakePool({"a": 1e-5})
    climb(tmp_path, pool, lambda results: Decision(False, 1_000_000), cell_budget=1.0)
    assert max(steps(pool)) == 1024


def test_hopeless_verdicts_come_after_others(tmp_path):
    """a needs more than its budget holds, b costs three times as much and is decided at 256 samples: b's verdict comes first."""
    pool = FakePool({"a": 1e-4, "b": 3e-4})
    needed = {"a": 10**9, "b": 256}
    climb(tmp_path, pool, lambda results: Decision(results[-1].trial.method == "b" and results[-1].trial.samples >= 256,
                                                   needed[results[0].trial.method]), cell_budget=3.0)  # fmt: skip
    order = [(trial.method, trial.samples) for trial in pool.asked if trial.replicate == 0]
    assert order == [("a", 64), ("b", 64), ("b", 256), ("a", 256), ("a", 1024), ("b", 1024)]


def test_cheap_steps_are_taken_without_looking_far_ahead(tmp_path):
    """4 ns a sample and step: a verdict 2^40 samples away is far beyond 1 s, but steps under 0.02 s are taken: to 4^11."""
    pool = FakePool({"a": 1e-9})
    climb(tmp_path, pool, lambda results: Decision(False, 2**40), cell_budget=1.0)
    assert max(steps(pool)) == 4**11


def test_a_verdict_that_no_samples_decide_gets_three_steps(tmp_path):
    """A verdict that stays undecided whatever the samples, and says so: three steps for the slope, no more."""
    pool = FakePool({"a": 1e-9})
    climb(tmp_path, pool, lambda results: Decision(False, None))
    assert max(steps(pool)) == 1024


def test_a_verdict_within_reach_is_climbed_to(tmp_path):
    """A verdict that needs 20,000 samples and is decided at the next step, 65,536."""
    pool = FakePool({"a": 1e-6})
    climb(tmp_path, pool, decided_at(20_000), cell_budget=1.0)
    assert max(steps(pool)) == 65_536


def test_the_ladder_ends(tmp_path):
    """A method that costs nothing and is never decided: the last step stays within 32 bits."""
    pool = FakePool({"a": 0.0}, deterministic=True)
    climb(tmp_path, pool, undecided)
    assert max(steps(pool)) == 2**30


def test_time_outs_follow_what_was_measured(tmp_path):
    """Films that took 5 s: the next step's, four times as long, may take ten times 20 s before they count as hanging."""
    pool = FakePool({"a": 5 / 64})
    climb(tmp_path, pool, decided_at(256), cell_budget=100)
    assert pool.timeouts[0] == 100
    assert pool.timeouts[4] == 200


def test_a_resumed_run_carries_on(tmp_path):
    """Interrupted after any number of trials and resumed: the same trials in all, none twice."""
    whole = FakePool({"a": 1e-5, "b": 1e-6})
    climb(tmp_path / "whole", whole, decided_at(1024))
    for stop in (0, 1, 5, 13, 23):
        first, rest = FakePool(whole.cost, status=stop_after(stop)), FakePool(whole.cost)
        record = store.create(tmp_path / str(stop), RUN, SCENES)
        with pytest.raises(KeyboardInterrupt):
            climb(tmp_path, first, decided_at(1024), record=record)
        climb(tmp_path, rest, decided_at(1024), record=record)
        assert len(rest.asked) == len(whole.asked) - stop
        assert sorted(map(str, first.asked[:-1] + rest.asked)) == sorted(map(str, whole.asked))


def stop_after(trials: int) -> Callable[[Trial], Status]:
    """A status that interrupts the run once so many trials have succeeded."""
    left = iter([Status.OK] * trials)

    def status(trial: Trial) -> Status:
        for ok in left:
            return ok
        raise KeyboardInterrupt

    return status


def test_a_resumed_run_counts_what_was_spent(tmp_path):
    """4 s of a budget of 10 s are recorded: the next step, of 16 s, is not begun."""
    record = store.create(tmp_path, RUN, SCENES)
    for replicate in range(REPLICATES):
        record.append(Result(trial(64, replicate, "a"), Status.OK, seconds={"render": 1.0}))
    pool = FakePool({"a": 1 / 64})
    climb(tmp_path, pool, undecided, budget=10, record=record)
    assert pool.asked == []


def test_progress_is_told(tmp_path):
    """Two methods of three steps: told before each step, and at the end with both finished."""
    told: list[Progress] = []
    climb(tmp_path, FakePool({"a": 1e-6, "b": 1e-6}), decided_at(1024), budget=7, told=told)
    assert [progress.cell is None for progress in told] == [False] * 6 + [True]
    assert (told[0].finished, told[-1].finished, told[-1].cells, told[-1].budget) == (0, 2, 2, 7)
    assert [progress.seconds for progress in told] == sorted(progress.seconds for progress in told)
