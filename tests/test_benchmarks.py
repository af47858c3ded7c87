"""The benchmarks' arithmetic, from fake measurements, and a page from a tiny real one. Nothing here depends on the clock."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lightproof import suite
from lightproof.renderers.pool import Pool
from lightproof.renderers.registry import METHODS
from lightproof.scale import Scale
from lightproof.trial import Result, Status

sys.path.append(str(Path(__file__).resolve().parents[1] / "benchmarks"))

import accuracy
import cache
import growth
import operations
import page
import sections
import throughput
from claims import MET, MISSED, OPEN, UNMEASURED, claims
from endings import Limit
from ladders import AT_MOST, EXTRAPOLATED, MEASURED, NEVER, SHORTEST, SINGLE, Ladder
from powers import fitted
from race import Film, Track, family, ours, race
from rows import Estimate, Row, Table, read

SAMPLES = 4.0 ** np.arange(6)
LOOP = """
.LBB0_1:
\tvpmulld\t%zmm0, %zmm1, %zmm1
\tvcvtdq2ps\t%zmm1, %zmm1
\tvcvtdq2ps\t%zmm2, %zmm2
\tvcvtdq2ps\t%zmm3, %zmm3
\tvcvtdq2ps\t%zmm4, %zmm4
\tvfmadd231ps\t%zmm1, %zmm2, %zmm3
\tvmulps\t(%rax), %zmm3, %zmm3
\tvdivps\t%zmm3, %zmm4, %zmm4
\tjne\t.LBB0_1
\tvaddps\t%zmm4, %zmm5, %zmm5
"""


def rate(method: str, *each: float, samples: float = 4096) -> Row:
    return Row("throughput", "square-light", method, "samples", samples, "render", "samples/s", each)


def timed(scene: str, method: str, per_sample: float, error: float, exponent: float = -0.5, note: str = "") -> list[Row]:
    """A ladder of three equal rounds: seconds in proportion to samples, errors by a power of them."""
    about = ("accuracy", scene, method, "samples")
    return [row for samples in SAMPLES for row in (
        Row(*about, samples, "render", "s", (per_sample * samples,) * 3),
        Row(*about, samples, "error", "1", (error * samples**exponent,) * 3, note),
    )]


def climbed(error: float, exponent: float) -> Ladder:
    shape = np.ones((3, 1))
    return Ladder("scene", "method", SAMPLES, shape * SAMPLES * 1e-3, shape * error * SAMPLES**exponent, False)


def test_throughput_claims_are_ratios_of_medians():
    """120 over 1 is met, 10 over 1 missed; rounds that spread over the target leave it open; fewer samples have no target."""
    rows = [rate("mc-area", 119, 120, 121), rate("mitsuba/sobol", 1, 1, 1), rate("mitsuba-loop", 12, 12, 12),
            rate("mc-area", 10, 10, 10, samples=64), rate("mitsuba", 1, 1, 1, samples=64)]
    found = {claim.text.split(",")[0]: claim for claim in claims(rows) if claim.target}
    outcomes = {text: claim.outcome for text, claim in found.items()}
    assert outcomes == {"mc-area over mitsuba/sobol": MET, "mc-area over mitsuba-loop": MISSED}
    assert found["mc-area over mitsuba/sobol"].measured.value == 120
    spread = [rate("mc-area", *range(80, 120, 5)), rate("mitsuba", *[1] * 8)]
    assert [claim.outcome for claim in claims(spread)] == [OPEN]


def test_time_to_error_claims_take_the_best_on_either_side():
    """Errors N^-1/2: ours takes 1 us a sample, the faster renderer 200 us: 200 at 0.1 %, by sampling; at 0.01 % analytic, whose
    first film of 2 us is better than that, is 10^10 us / 2 us ahead. A furnace scene needs 30 only."""
    rows = [row for scene in ("square-light", "white-furnace-plane") for row in (
        *timed(scene, "mc-area", 1e-6, 0.02), *timed(scene, "mc-cosine", 3e-6, 0.02), *timed(scene, "cycles", 9e-4, 0.02),
        *timed(scene, "luxcore", 2e-4, 0.02), *timed(scene, "analytic", 2e-6, 1e-12, note="no noise"))]
    found = claims(rows)
    assert [(claim.target, claim.outcome) for claim in found] == [(100, MET), (1000, MET), (30, MET), (1000, MET)]
    assert found[0].measured.value == pytest.approx(200) and "luxcore" in found[0].note and "mc-area" in found[0].note
    assert found[1].measured.value == pytest.approx(2e-4 * (0.02 / 1e-4) ** 2 / 2e-6) and "analytic (at most)" in found[1].note


@pytest.mark.parametrize(("beside", "best"), [("mc-area", "mc-area"), ("mc-cosine", "path")])
def test_path_is_no_candidate_beside_the_kernel_that_it_shares(beside, best):
    """Path is the faster by luck; where mc-area refuses the scene it is a method of its own."""
    rows = [*timed("square-light", beside, 1.1e-6, 0.02), *timed("square-light", "path", 1e-6, 0.02),
            *timed("square-light", "cycles", 9e-4, 0.02)]
    assert claims(rows)[0].note == f"cycles over {best}"


def test_what_nobody_measured_is_neither_met_nor_missed():
    found = claims(timed("square-light", "mc-area", 1e-6, 0.02))
    assert {claim.outcome for claim in found} == {UNMEASURED} and "no renderer" in found[0].note


def test_time_to_error_is_interpolated_extrapolated_or_never():
    """Errors 0.02 N^-1/2 at 1 ms a sample: 1 % at N = 4, 0.1 % at N = 400, between steps; 0.01 % at N = 40,000 is beyond. An
    error that stays has no time, and a better first step is a bound."""
    falling = climbed(0.02, -0.5)
    assert [falling.time_to(error) for error in (0.01, 0.001, 0.0001)] == pytest.approx([4e-3, 0.4, 40])
    assert [falling.kind(error) for error in (0.5, 0.01, 0.001, 0.0001)] == [AT_MOST, MEASURED, MEASURED, EXTRAPOLATED]
    assert climbed(0.02, 0).kind(0.01) == NEVER and np.isinf(climbed(0.02, 0).time_to(0.01))


@pytest.mark.parametrize(("errors", "seconds", "ends"), [
    ([1e-3, 4e-5], 1e-3, False),  # one step below 5e-5 may be luck
    ([4e-5, 6e-5], 1e-3, False),
    ([4e-5, 3e-5], 1e-3, True),
    ([1e-1] * 5, 0.2, True),  # the next film takes 0.8 s and leads nowhere
    ([1e-1] * 5, 0.1, False),
    ([1e-1] * 4, 0.2, False),  # too few steps to see how the error falls
    ([1e-1] * 4, 0.7, True),
    ([4e-3, 1.2e-3], 0.7, False),  # one film of 2.8 s leads beyond 1e-3
    ([4e-3, 1.2e-3], 0.8, True),
    ([0.5, 0.1, 2e-2, 4e-3, 1.2e-3], 0.7, False),
    ([0.5, 0.1, 2e-2, 4e-3, 0.7e-3], 0.7, True),  # that film is behind it
    ([0.5, 0.3, 0.1, 3e-2, 1.2e-2], 0.2, True),  # no claim is about 1 %
])
def test_a_ladder_ends(errors, seconds, ends):
    """A film may take 0.5 s, one that leads beyond an error of 0.1 or 0.01 % 3 s, one of the first five steps 2.5 s."""
    assert Limit(0.5, 3.0).ends(errors, [seconds] * len(errors)) is ends


@pytest.mark.parametrize(("slower", "note", "outcome", "sign"), [
    (200, "", OPEN, "≤ "), (200, SINGLE, MET, ""), (20, "", MISSED, "≤ "), (20, SINGLE, MISSED, "")])
def test_a_renderer_that_may_have_been_sooner_leaves_its_claim_open(slower, note, outcome, sign):
    """Its first film is better than 0.1 %: 200 times as slow as ours is not known to be 100 times, but where that film took one
    sample, the least; 20 times is too few in any case."""
    rows = [*timed("square-light", "mc-area", 1e-6, 1e-4), *timed("square-light", "cycles", slower * 1e-6, 1e-4)]
    rows = [replace(row, note=note) if row.phase == "render" and row.value == 1 else row for row in rows]
    claim = claims(rows)[0]
    assert (claim.outcome, claim.sign, claim.measured.value) == (outcome, sign, pytest.approx(slower))
    assert accuracy.ladders(rows)[1].kind(0.001) == (SHORTEST if note else AT_MOST)


def test_what_is_extrapolated_is_marked():
    """Renderer's errors 0.02 N^-1/2 end at N = 1,024: 0.1 % is measured, 0.01 % not; in the claims and in the tables."""
    rows = [*timed("square-light", "mc-area", 1e-6, 0.02, exponent=-1), *timed("square-light", "cycles", 9e-4, 0.02)]
    rows += accuracy.times(accuracy.ladders(rows))
    html = page.render(rows, {})
    assert ["extrapolated" in page.cells(claim)[3] for claim in claims(rows)] == [False, True]
    assert page.cells(claims(rows)[1])[3].startswith("≈ ") and html.count(", extrapolated (") == 1


@pytest.mark.parametrize(("grown", "outcome"), [(0.2, MET), (16.8, MISSED)])
def test_memory_that_grows_with_samples_is_seen(grown, outcome):
    """Beside 180 MB of the process: 16.8 MB are one float32 for each of 4,194,304 samples, 9 % of them."""
    each = {64: 180.0, 4194304: 180.0 + grown}
    found = claims([Row("growth", "s", "mc-area", "samples", value, "memory", "MB", (mb,) * 3) for value, mb in each.items()])
    assert (found[0].outcome, found[0].measured.value) == (outcome, pytest.approx(grown))


def test_exponents_are_fitted_beside_an_overhead():
    """Seconds 1e-3 + 2e-7 x^1.5 over six decades."""
    rows = [Row("growth", "s", "m", "blockers", x, "render", "s", (1e-3 + 2e-7 * x**1.5,) * 3) for x in 10.0 ** np.arange(7)]
    power = fitted(rows)
    assert (power.exponent.value, power.overhead) == pytest.approx((1.5, 1e-3), rel=1e-4)


def test_fresh_processes_load_every_kind_of_kernel_and_may_keep_bytecode(monkeypatch):
    """Every family of ours but the naive one, and every kind of points."""
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    assert set(os.environ) - set(cache.environment()) == {"PYTHONDONTWRITEBYTECODE"}
    methods = {method for _, method in cache.KERNELS}
    assert {family(method) for method in methods} == {family(entry.name) for entry in ours()}
    assert {method.partition("/")[2] for method in methods} == {"", "jitter", "lattice", "sobol", "recursion"}


def test_set_up_is_told_over_the_whole_curve():
    """Seconds 1e-3 x^2 of one method, which stops at 100, and 1 ms of another, which has no exponent."""
    about = ("growth", "s")
    rows = [Row(*about, "m", "lights", x, phase, "s", (1e-3 * x**2,)) for x in (1, 10, 100) for phase in ("render", "setup")]
    rows += [Row(*about, "n", "lights", x, "setup", "s", (1e-3,)) for x in (1, 10, 100, 1000)]
    part = sections.setting_up([row for row in rows if row.phase == "setup"], ["m", "n"])
    assert part.head == ("method", "exponent", "1", "10", "100", "1,000")
    assert part.body == [["m", "2", "1 ms", "100 ms", "10 s", "—"], ["n", "—", *["1 ms"] * 4]]


def test_accuracy_tells_set_up_compilation_and_rendering_apart():
    taken = {"setup": 2, "compile": 3}
    once = [Row("accuracy", "s", "mc-area", "samples", 1, phase, "s", (seconds,)) for phase, seconds in taken.items()]
    part = sections.accuracy([*timed("s", "mc-area", 1e-6, 0.02), *once])[0]
    assert part.head[1:] == ("render to 1 %", "render to 0.1 %", "render to 0.01 %", "set-up", "compile")
    assert part.body[0][-2:] == ["2 s", "3 s"]


def test_operations_are_counted_in_the_loop_alone():
    """Four conversions of 16 lanes are 16 samples: a multiply-add, a product and a quotient are 4 operations each, a product of
    whole numbers 1; the sum behind the jump is outside."""
    found = operations.count(LOOP)
    assert (found.floating, found.whole, found.packed_multiply_adds, found.lanes) == (4, 1, 1, 16)
    assert operations.count("add x0, x0, x1") is None


def test_rows_come_back_from_the_csv(tmp_path):
    rows = [rate("mc-area", 3, 1, 2),
            Row("growth", "a, b", "m", "error", 0.1, "render", "s", estimate=Estimate(1, 0.5, np.inf)),
            Row("growth", "s", "m", "lights", 3, "error", "", note="it broke")]
    with Table(tmp_path / "new" / "benchmarks.csv") as table:
        table.add(rows)
        assert read(tmp_path / "new" / "benchmarks.csv") == rows
    assert (rows[0].median, rows[0].interval) == (2, (1, 3))


def test_lights_share_samples_and_not_nodes():
    """64 samples for each light; a node takes in every light."""
    points = list(growth.lights())
    assert {point.samples / point.amount for point in points} == {64}
    assert len({point.nodes for point in points}) == 1


@pytest.mark.parametrize("points", [growth.lights, growth.blockers])
def test_grown_scenes_hold_what_they_say(points):
    """So many lights or blockers, none on top of another: centres are farther apart than sides are long."""
    point = next(point for point in points() if point.amount == 100)
    shapes = [item.shape for item in (*point.scene.lights, *point.scene.surfaces)]
    assert len(shapes) == (100 if point.parameter == "lights" else 101)
    corners = np.array([shape.vertices for shape in shapes[-100:]])
    centres, sides = corners.mean(axis=1), np.ptp(corners, axis=1)[:, :2]
    gaps = np.abs(centres[:, None, :2] - centres[None, :, :2])
    assert ((gaps > sides).any(axis=-1) | np.eye(100, dtype=bool)).all()


def scale(scene):
    return Scale.of(scene, suite.default().reference(scene))


@pytest.fixture
def track(tmp_path, monkeypatch):
    """As many seconds as it takes, for a ladder of 1 to 256 samples."""
    monkeypatch.setattr(accuracy, "MOST", 256)
    with Pool(threads=1) as pool:
        yield Track(pool, tmp_path, lambda message: None, seconds=1e9)


def test_page_from_a_tiny_measurement(track, monkeypatch):
    """Two of ours on a point light, one of them in a renderer's place: errors fall, and the page has what was measured."""
    stranger = METHODS["mc-area/jitter"]
    monkeypatch.setattr(accuracy, "renderers", lambda: {"stranger": [stranger]})
    scene, rows = suite.default().scene("point-light"), []
    accuracy.race(track, scene, scale(scene), [METHODS["mc-area"]], rows.extend, rounds=2)
    assert {row.method for row in rows} == {"mc-area", "mc-area/jitter"}
    errors = [row.median for row in rows if row.phase == "error" and row.method == "mc-area"]
    assert len(errors) == 5 and errors[0] > 4 * errors[-1] > 0
    html = page.render(rows, {"Machine": "<here>"})
    assert "point-light" in html and "&lt;here&gt;" in html and 'src="' not in html.split("<script>")[0]


def test_tracks_take_turns(track, monkeypatch):
    """Two tracks, two films, one of which fails on the second track in the second round: A B A B, and no third turn for it."""
    turns, scene = [], suite.default().scene("point-light")
    films = [Film(METHODS[name], scene, 1) for name in ("mc-area", "analytic")]

    def steady(self, film, turn):
        turns.append(("one" if self is track else "two", film.entry.name, turn))
        return Result(None, Status.ERROR if turns[-1] == ("two", "analytic", 2) else Status.OK)

    monkeypatch.setattr(Track, "steady", steady)
    with track.fresh() as other:
        taken = {(lane, film): [] for film in films for lane in (track, other)}
        race(taken, rounds=3)
    order = [("one", "mc-area"), ("two", "mc-area"), ("one", "analytic"), ("two", "analytic")]
    assert turns == [(*pair, turn) for turn in (1, 2, 3) for pair in order[: 3 if turn == 3 else 4]]
    assert [len(results) for results in taken.values()] == [3, 3, 3, 1]


def test_what_was_measured_survives_an_interruption(track, monkeypatch):
    """Interrupted in the second film of the first round: the first is kept."""
    render, seen = track.render, []

    def interrupted(film, turn):
        seen.append(film)
        if turn and len([one for one in seen if one == film]) > 1 and film.samples > 1:
            raise KeyboardInterrupt
        return render(film, turn)

    monkeypatch.setattr(track, "render", interrupted)
    monkeypatch.setattr(accuracy, "renderers", dict)
    scene, rows = suite.default().scene("point-light"), []
    with pytest.raises(KeyboardInterrupt):
        accuracy.race(track, scene, scale(scene), [METHODS["mc-area"]], rows.extend, rounds=2)
    assert [row.value for row in rows if row.phase == "error" and row.each] == [1]


def test_a_missing_renderer_is_told_and_left_out(track):
    broken = METHODS["mitsuba"].__class__("broken", "nowhere.to.be.found:Method", worker="broken")
    assert track.there([broken, METHODS["mc-area"]]) == [METHODS["mc-area"]] and "broken" in track.left_out


@pytest.mark.parametrize("entry", [throughput.LOOP, throughput.BUNDLE], ids=lambda entry: entry.name)
def test_mitsuba_by_hand_gives_the_right_light(track, entry):
    """The floor in a soft shadow, 4,096 light samples per element: the mean to 0.2 %."""
    pytest.importorskip("mitsuba")
    scene = suite.default().scene("occluded-square")
    result = track.render(Film(entry, scene, 4096), 1)
    assert (result.message, result.samples) == ("", 4096)
    assert result.film.mean() == pytest.approx(suite.default().reference(scene).value.mean(), rel=2e-3)
