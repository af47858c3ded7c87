"""Hard cases: rare samples accuse nobody, the textbook is as wrong as it is, and the page says where methods break."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from cells import LIGHT, SCENE, noisy, reference, results

from lightproof import films, statistics, store, suite, verdict
from lightproof.cli import main
from lightproof.estimators.mc_area import McArea
from lightproof.estimators.mc_solid_angle import McSolidAngle
from lightproof.estimators.textbook import Textbook
from lightproof.judging import Judge
from lightproof.reporting import hard, hard_charts, hard_findings, hard_page, hard_promises, hard_spread, page, sweeps
from lightproof.reporting.configurations import together
from lightproof.reporting.evaluation import Cell, Evaluation
from lightproof.reporting.hard_deviation import Deviation
from lightproof.scene import Scene
from lightproof.store import Run
from lightproof.trial import Result, Status, Trial
from lightproof.verdict import Outcome, Verdict

CATALOGUE = suite.default()
ELEMENTS = SCENE.size
DISTANCE = CATALOGUE.scene("hard-distance")
EXACT = CATALOGUE.reference(DISTANCE)


# The verdict

def judged(films: dict[int, np.ndarray], peak: float | None) -> Verdict:
    """Of 16 films a step whose largest possible sample is `peak` [W/m2] in every element; 4 W/m2 is the scale, 0.02 tolerated."""
    peaks = None if peak is None else np.full(ELEMENTS, peak)
    return verdict.judge(results(films, peak=peaks), reference(), SCENE)


def dark(share: float = 1.0) -> dict[int, np.ndarray]:
    """Two steps of films that lack a share of the light everywhere, with next to no noise."""
    return {samples: noisy((1 - share) * LIGHT, 1e-6, seed=samples) for samples in (64, 256)}


def test_a_missing_light_that_one_sample_could_bring_is_no_failure():
    """Black films: a fail, unless one sample of 64 x 16 could carry a million W/m2; then no scatter tells."""
    assert judged(dark(), None).outcome is Outcome.FAIL
    found = judged(dark(), 1e6)
    assert found.outcome is Outcome.UNDECIDED
    assert "a single sample could move it by up to" in found.reason
    assert "mc-solid-angle" in found.reason


def test_samples_that_cannot_hide_the_light_still_accuse():
    """A sample of 10 W/m2 among 1,024 moves an element by 0.01, half of what is tolerated."""
    assert judged(dark(), 10.0).outcome is Outcome.FAIL


def test_a_tile_is_moved_by_its_elements_share_only():
    """A sample of 50 W/m2 moves an element by 0.05 and its tile of four by 0.0125: the tiles may accuse, the elements may not."""
    assert judged(dark(), 50.0).outcome is Outcome.FAIL
    spot = np.arange(ELEMENTS) == 100
    one = {samples: noisy(LIGHT - 0.06 * spot, 1e-6, seed=samples) for samples in (64, 256)}
    assert judged(one, 1.0).outcome is Outcome.FAIL
    assert judged(one, 500.0).outcome is Outcome.UNDECIDED


def test_the_samples_that_would_tell_are_named():
    """Peak over samples has to fall to the tolerance: of the whole film, 1e6 W/m2 / (16 x 0.02) a film."""
    assert judged(dark(), 1e6).samples_needed == pytest.approx(1e6 / (16 * 0.02), rel=1e-3)
    assert judged(dark(), np.inf).samples_needed is None
    assert "without bound" in judged(dark(), np.inf).reason


def test_a_peak_takes_no_pass_away_and_gives_none():
    """The exact light passes whatever a sample can be. One element off that its tile dilutes forbids the pass all the same."""
    assert judged({64: noisy(LIGHT, 0.01)}, np.inf).outcome is Outcome.PASS
    spot = LIGHT + 0.064 * (np.arange(ELEMENTS) == 100)
    assert judged({64: noisy(spot, 0.001), 256: noisy(spot, 0.001, seed=2)}, np.inf).outcome is Outcome.UNDECIDED


def test_the_share_of_a_tile():
    """Of 2 x 4 elements in two tiles of 2 x 2 the largest, over four."""
    assert statistics.tile_shares(np.array([1.0, 2, 3, 4, 8, 7, 6, 5]), (2, 4), 2).tolist() == [2, 1.5]


# The largest sample

@pytest.mark.parametrize(("method", "name"), [
    (McArea, "hard-distance"), (McArea, "hard-distance:sphere"), (McArea, "square-light"), (McSolidAngle, "hard-distance"),
])
def test_no_sample_is_larger_than_the_bound(method, name):
    """The largest of 100 samples at each element is below the bound, and somewhere not far below."""
    made = prepared(method("any", 1), name)
    drawn = [made.render(1, seed + 1) for seed in range(100)]
    largest, bound = np.max([one.film for one in drawn], axis=0), drawn[0].peak
    assert (largest <= 1.0001 * bound).all()
    assert (largest > 0.3 * bound).any()


def test_a_micrometre_from_the_lamp_only_points_of_it_know_no_bound():
    """Values that samples of the area and of the solid angle may have, over the light there is."""
    by_area, by_angle = (prepared(method("any", 1), "hard-distance").render(1, 1).peak[0] for method in (McArea, McSolidAngle))
    assert by_area > 1e10 * EXACT.value[0]
    assert by_angle < 10 * EXACT.value[0]


def test_points_of_a_lamp_in_float32_see_it_from_almost_its_plane():
    """From 1 to 10^-11 degrees above it, the light to 1e-5."""
    made = prepared(McArea("mc-area/sobol", 1), "hard-grazing")
    film = np.mean([made.render(1 << 14, seed).film for seed in range(1, 5)], axis=0)
    assert film == pytest.approx(CATALOGUE.reference(CATALOGUE.scene("hard-grazing")).value, rel=1e-5)


def test_points_of_a_sphere_in_float32_are_numbers_from_next_to_it():
    """Down to 0.4e-12 m from a radius of 0.5 m: no NaN, and the light where the points are not too rare, from 4 cm."""
    film = prepared(McArea("mc-area/sobol", 1), "hard-approach:sphere").render(1 << 16, 1).film
    assert np.isfinite(film).all()
    assert film[[0, 5]] == pytest.approx(CATALOGUE.reference(CATALOGUE.scene("hard-approach:sphere")).value[[0, 5]], rel=1e-3)


def prepared(method: McArea, name: str) -> McArea:
    method.prepare(CATALOGUE.scene(name))
    return method


def test_a_run_near_the_lamp_is_undecided_and_says_why(tmp_path):
    """From worker to verdict: mc-area a micrometre from the lamp."""
    assert main(["run", "hard-distance", "--with", "mc-area", "--budget", "2", "--replicates", "8", "--out", str(tmp_path)]) == 0
    record = store.latest(tmp_path)
    kept = record.results()
    assert all(result.peak[0] > 1e10 for result in kept)
    found = Judge(record).judge(kept)
    assert found.outcome is Outcome.UNDECIDED
    assert "a single sample could move it" in found.reason


def test_a_film_keeps_every_bit(tmp_path):
    """float64 of all magnitudes, and a peak without bound."""
    values = np.geomspace(1e-18, 1e18, 12) * np.random.default_rng(1).random(12)
    films.write(tmp_path / "a.exr", (3, 4), {"Y": values, "peak": np.full(12, 1e300)}, {})
    channels = films.read(tmp_path / "a.exr")[1]
    assert (channels["Y"] == values).all()
    assert np.isinf(channels["peak"]).all()


# The textbook

def textbook(name: str, scene: Scene) -> np.ndarray:
    method = Textbook(name, 1)
    assert method.unsupported(scene) is None
    method.prepare(scene)
    return method.render(1, 1).film


def test_the_textbook_is_right_on_paper():
    """A square, a sphere and a level disk from 1 m: float64 to its rounding, float32 to its own."""
    for case in ("base", "sphere", "disk"):
        scene = CATALOGUE.cases("hard-distance")[case]
        exact = CATALOGUE.reference(scene).value[6]
        for name, rounding in (("textbook", 1e-14), ("textbook/float32", 1e-5)):
            assert textbook(name, scene)[6] == pytest.approx(exact, rel=rounding), (case, name)
        assert textbook("textbook/float32", scene)[6] != textbook("textbook", scene)[6]


@pytest.mark.parametrize(("name", "method", "least"), [
    ("hard-distance", "textbook", 1.0),  # arccos, far away
    ("hard-grazing:sliver", "textbook", 0.9),  # no horizon
    ("hard-tiny-solid-angle:sphere-angle", "textbook", 1e-4),  # 1 - cos
    ("hard-tiny-solid-angle:triangle-angle", "textbook", 0.1),  # spherical excess
    ("hard-translation:moved-1e4", "textbook/float32", 1e-3),  # planes in world coordinates
    ("hard-reflectance:one-in-1e6", "textbook/float32", 1e-3),  # 1 - rho
])
def test_the_textbook_breaks_where_it_should(name, method, least):
    """Else it were no foil: and at none of these does `analytic` lose more than 1e-12 (see test_analytic)."""
    scene = CATALOGUE.scene(name)
    exact = CATALOGUE.reference(scene).value
    assert (np.abs(textbook(method, scene) - exact) / exact).max() > least


@pytest.mark.parametrize(("name", "reason"), [
    ("square-light", "for points"),
    ("hard-reflectance:bulb", "glows and reflects evenly"),
    ("hard-tiny-solid-angle:disk-angle", "axis"),
])
def test_what_no_textbook_prints(name, reason):
    assert reason in Textbook("textbook", 1).unsupported(CATALOGUE.scene(name))


# The page

def given(method: str, films: np.ndarray, scene: Scene = DISTANCE, precision: str = "float32", **fields: object) -> Cell:
    """A cell of films (R, n) of a hard case."""
    kept = [Result(Trial(scene.id, scene.case, scene.digest, method, 64, k), Status.OK, film=film, samples=64,
                   precision=precision, seconds={"render": 1.0}, **fields) for k, film in enumerate(films)]
    exact = CATALOGUE.reference(scene)
    return Cell(scene, method, tuple(kept), exact, verdict.judge(kept, exact, scene))


def failed(method: str, message: str) -> Cell:
    trial = Trial(DISTANCE.id, DISTANCE.case, DISTANCE.digest, method, 64, 0)
    kept = (Result(trial, Status.ERROR, message=message),)
    return Cell(DISTANCE, method, kept, EXACT, verdict.judge(kept, EXACT, DISTANCE))


@pytest.fixture(scope="module")
def cells() -> tuple[Cell, ...]:
    """An exact method; one that loses a tenth from 10^4 m on; one with noise; one blind below 1e-4 m; one that gives NaN."""
    value, random = EXACT.value, np.random.default_rng(3)
    noise = value * random.normal(0, 1e-3, (16, len(value)))
    far = sweeps.values(DISTANCE) >= 1e4
    near = sweeps.values(DISTANCE) <= 1e-4
    peak = np.where(near, 1e12, 1.0) * value
    return (
        given("exact", value[None], deterministic=True),
        given("far", value + noise - 0.1 * value * far),
        given("noisy", value + noise),
        given("blind", value + noise - 0.99 * value * near, peak=peak),
        failed("broken", "a.exr: 1 of 15 values of Y are no light, the first nan in element 3; every value must be finite"),
    )


@pytest.fixture(scope="module")
def evaluation(cells) -> Evaluation:
    run = Run("run-1", "2026-01-02T03:04:05+00:00", "digest", "a machine", 2, 7, {}, "abc", {})
    return Evaluation(run, (DISTANCE,), cells)


@pytest.fixture(scope="module")
def squares(evaluation) -> dict[str, hard.Square]:
    (row,) = hard.rows(evaluation)
    return {square.method: square for square in row.squares}


def test_noise_is_set_apart_from_what_is_systematic(squares):
    """A tenth is seen through noise of a thousandth; noise alone shows nothing; rare samples hide what is missing."""
    assert squares["exact"].text == "exact"
    assert squares["far"].deviation.level == pytest.approx(0.1, rel=0.02)
    assert (squares["far"].deviation.systematic > 0.09).sum() == (sweeps.values(DISTANCE) >= 1e4).sum()
    assert squares["noisy"].text.startswith("±") and not squares["noisy"].deviation.off
    assert squares["blind"].deviation.unbounded
    assert "a single sample could move the mean" in squares["blind"].told


def test_a_square_says_where_it_is_worst(squares):
    assert "distance to the lamp" in squares["far"].told and "standard error of 16 films of 64 samples" in squares["far"].told
    assert squares["broken"].text == "NaN"
    assert "(the first at distance to the lamp 0.001 m (point 3))" in squares["broken"].told


def test_units_in_the_last_place(squares):
    """0.1 of a value is between 2^20 and 2^21 times a tenth of them in float32, whose digits are 24."""
    far = squares["far"].deviation
    assert 2**23 * 0.09 < far.ulps[far.worst] < 2**24 * 0.11


def test_sentences_say_where_each_method_breaks(evaluation):
    (group,) = hard.groups(hard.rows(evaluation))
    said = hard_findings.findings(group)
    assert said["off by more than 1 % at a distance to the lamp of 10⁴ m and more"] == ["far"]
    assert said["no systematic error of more than 1 %"] == ["exact", "noisy"]
    (blind,) = said["blind to errors of more than 1 % at a distance to the lamp of 0.0001 m and less: a single sample can weigh"
                    " up to the share of the light in brackets"]
    assert blind == "blind (1e9 times)"
    assert said["no light but NaN, first at distance to the lamp 0.001 m (point 3)"] == ["broken"]


def judged_on(scenes: Sequence[Scene], *cells: Cell) -> Evaluation:
    run = Run("run-1", "2026-01-02T03:04:05+00:00", "digest", "a machine", 2, 7, {}, "abc", {})
    return Evaluation(run, tuple(scenes), cells)


def said_of(evaluation: Evaluation) -> dict[str, list[str]]:
    (group,) = hard.groups(hard.rows(evaluation))
    return hard_findings.findings(group)


def scattered(share: float | np.ndarray, method: str = "mc-area", scene: Scene = DISTANCE, **fields: object) -> Cell:
    """16 films of the exact light with noise of a standard deviation of a share of it."""
    value = CATALOGUE.reference(scene).value
    return given(method, value * (1 + share * np.random.default_rng(4).normal(size=(16, len(value)))), scene, **fields)


def test_a_method_with_much_scatter_is_not_called_sound():
    """Its films differ by 40 % from 1 m on, and by a thousandth below: noise of its mean hides about 0.4 / 4 x 7.3."""
    beyond = sweeps.values(DISTANCE) >= 1
    said = said_of(judged_on([DISTANCE], scattered(np.where(beyond, 0.4, 0.001))))
    (sentence, (label,)), = said.items()
    assert sentence == ("blind to errors of more than 1 % at a distance to the lamp of 1 m and more: noise hides up to the share"
                        " of the light in brackets")
    assert re.fullmatch(r"mc-area \((6|7|8|9|10)\d\s%\)", label)


def test_configurations_of_which_the_same_is_true_are_named_together():
    """All those that the run has, with the same in brackets: not so where one is missing, or another amount is said of it."""
    run = ["analytic", "mc-area", "mc-area/sobol", "mc-area/float64", "path", "path/sobol", "mc-mis", "mc-mis/sobol", "mine"]
    said = {"analytic": "", "mc-area": "7 %", "mc-area/sobol": "7 %", "mc-area/float64": "7 %", "path": "", "mc-mis": "",
            "mc-mis/sobol": "8 %", "mine": "9 %"}
    assert together(said, run) == ["analytic", "mc-area (all 3, 7 %)", "path", "mc-mis", "mc-mis/sobol (8 %)", "mine (9 %)"]
    assert together(dict.fromkeys(run, ""), run) == ["analytic", "mc-area (all 3)", "path (all 2)", "mc-mis (all 2)", "mine"]


def test_sentences_name_configurations_together():
    """Two of one method that hold, and one of two of another."""
    cells = [scattered(1e-4, name) for name in ("mc-area", "mc-area/sobol", "mc-mis")] + [scattered(10, "mc-mis/sobol")]
    assert said_of(judged_on([DISTANCE], *cells))[hard_findings.SOUND] == ["mc-area (all 2)", "mc-mis"]


STRIPS = [CATALOGUE.scene(f"hard-aspect{case}") for case in ("", ":strip-1e4", ":strip-1e8")]


def test_a_method_is_sound_only_where_every_case_was_measured():
    """Of three cases of a sweep: one method has all, one lacks the last, one ends in an error there, one refuses it."""
    trial = Trial(STRIPS[2].id, STRIPS[2].case, STRIPS[2].digest, "", 64, 0)
    ended = {
        "crashes": Result(replace(trial, method="crashes"), Status.ERROR, message="it wrote nothing"),
        "refuses": Result(replace(trial, method="refuses"), Status.UNSUPPORTED, message="too thin"),
    }
    exact = CATALOGUE.reference(STRIPS[2])
    last = [Cell(STRIPS[2], name, (result,), exact, verdict.judge([result], exact, STRIPS[2])) for name, result in ended.items()]
    measured = [scattered(1e-4, method, scene) for scene in STRIPS[:2] for method in ("all", "lacks", *ended)]
    said = said_of(judged_on(STRIPS, *measured, scattered(1e-4, "all", STRIPS[2]), *last))
    assert said == {
        "nothing but an error on hard-aspect:strip-1e8": ["crashes"],
        "not reached by this run on hard-aspect:strip-1e8": ["lacks"],
        "no systematic error of more than 1 %": ["all", "refuses"],
        "no systematic error of more than 1 % elsewhere": ["crashes", "lacks"],
    }


def test_of_a_single_film_nobody_knows_the_noise():
    said = said_of(judged_on([DISTANCE], given("once", EXACT.value[None])))
    assert "no systematic error of more than 1 %" not in said
    assert "a single film, of unknown noise," in said


def promise_of(word: str, evaluation: Evaluation) -> hard_promises.Promise:
    (found,) = (promise for promise in hard_promises.promises(hard.rows(evaluation)) if word in promise.text)
    return found


@pytest.mark.parametrize(("share", "loss", "kept", "said"), [
    (1e-2, 0.0, None, "in 0 of 1 squares; in the median square the smallest error that could have been seen is 2e−2"),
    (1e-7, 0.0, True, "in 1 of 1 squares; in the median square the smallest error that could have been seen is "),
    (1e-7, 1e-4, False, "the largest that noise does not explain is 1e−4, by mc-area on hard-distance at distance to the lamp"),
])
def test_a_promise_that_noise_hides_is_open(share, loss, kept, said):
    """mc-area, in float32: noise of a hundredth could hide 1e-5, of 1e-7 shows that there is none, or that there is 1e-4."""
    cell = scattered(share)
    lossy = given("mc-area", np.array([result.film for result in cell.results]) - loss * EXACT.value)
    found = promise_of("float32", judged_on([DISTANCE], lossy))
    assert found.kept is kept
    assert said in found.text


@pytest.mark.parametrize(("loss", "other", "kept", "said"), [
    (0.0, 0.0, True, "by no more than their scatter. 1e−5 could be seen at every point in 1 of 1 pairs."),
    (1e-4, 0.0, False, "by up to 1e−4 beyond their scatter, of mc-area on hard-distance at distance to the lamp"),
    (0.0, 1e-3, None, "by no more than their scatter. 1e−5 could be seen at every point in 0 of 1 pairs."),
])
def test_rounding_is_told_apart_from_noise(loss, other, kept, said):
    """Films of the same points in both precisions, with noise of 40 %: that they differ by nothing or by 1e-4 shows all the same,
    but not where each has noise of its own."""
    random, value = np.random.default_rng(5), EXACT.value
    films = value * (1 + 0.4 * random.normal(size=(16, len(value))))
    single = given("mc-area", films + value * (other * random.normal(size=films.shape) - loss))
    found = promise_of("Rounding alone", judged_on([DISTANCE], single, given("mc-area/float64", films, precision="float64")))
    assert found.kept is kept
    assert said in found.text


def test_black_films_tell_nothing_of_rounding():
    """Where light is due and neither precision met any, their films are alike."""
    dark = EXACT.value * (sweeps.values(DISTANCE) >= 1)
    single, double = (given(name, np.tile(dark, (16, 1)) + 1e-6 * dark * np.arange(16)[:, None], precision=precision)
                      for name, precision in (("mc-area", "float32"), ("mc-area/float64", "float64")))
    found = promise_of("Rounding alone", judged_on([DISTANCE], single, double))
    assert found.kept is None
    assert "in 0 of 1 pairs" in found.text


def test_rounding_needs_films_of_the_same_points():
    """Of one method in both precisions, and of replicates and samples that both have; of others there is nothing to tell."""
    films = np.array([result.film for result in scattered(0.4).results])
    for name, others in (("mc-area/sobol-float64", films), ("mc-area/float64", films[:1])):
        double = given(name, others, precision="float64")
        told = hard_promises.promises(hard.rows(judged_on([DISTANCE], given("mc-area", films), double)))
        assert not any("Rounding alone" in promise.text for promise in told)


def test_what_analytic_was_not_asked_keeps_its_promise_open():
    exact = given("analytic", CATALOGUE.reference(STRIPS[0]).value[None], STRIPS[0], deterministic=True)
    assert promise_of("analytic", judged_on(STRIPS[:1], exact)).kept is True
    assert promise_of("analytic", judged_on(STRIPS[:2], exact, scattered(1e-4, "mc-area", STRIPS[1]))).kept is None


def test_films_that_are_alike_may_have_missed_one_dark_sample_in_a_thousand():
    """1,024 samples, each of 1.001 times the light: if one in a thousand were black, the mean would be right, and there were no
    such sample among them once in three runs. Of 1.1 times the light the same cannot be."""
    for excess, certain in ((1.001, False), (1.1, True)):
        alike = Deviation(given("mc-cosine", np.tile(excess * EXACT.value, (16, 1))))
        assert (alike.systematic > 0).all() == alike.off == certain


def test_an_open_promise_is_shown_as_open():
    html = hard_page.render(judged_on([DISTANCE], scattered(1e-2)), page.environment(), "")
    assert 'badge undecided"><span aria-hidden="true">?</span> open' in html


def test_the_page_shows_all_of_it(evaluation):
    """Every method's square with its tooltip, the sweep's chart, and nothing where no case is hard."""
    html = hard_page.render(evaluation, page.environment(), "")
    assert html.count("<td class=") == 5
    assert 'class="broken"' in html and "NaN" in html
    assert "distance to the lamp [m]" in html
    easy = replace(DISTANCE, tags=("direct",))
    assert hard_page.render(replace(evaluation, scenes=(easy,)), page.environment(), "") == ""


def test_the_chart_has_the_worst_of_the_points_that_share_a_value():
    """hard-approach has three points at each of five distances."""
    scene = CATALOGUE.scene("hard-approach")
    value = CATALOGUE.reference(scene).value
    film = value * (1 + np.arange(len(value)) / 100)
    run = Run("run-1", "2026-01-02T03:04:05+00:00", "digest", "a machine", 2, 7, {}, "abc", {})
    (group,) = hard.groups(hard.rows(Evaluation(run, (scene,), (given("mine", film[None], scene, deterministic=True),))))
    (points,) = hard_charts.error_along(group, ["mine"])["datasets"].values()
    assert sorted(point["value"] for point in points) == pytest.approx([0.1, 0.11, 0.12, 0.13, 0.14])


def test_a_page_says_whose_variance_explodes_and_whose_does_not():
    """At every distance the mean of one method's samples is right, but below 1 m they scatter by 100 times the light; another's
    films of rare samples lack the light below 1e-4 m, as it says itself; a third lacks it and says nothing; the last is even."""
    at, value = sweeps.values(DISTANCE), EXACT.value
    one_sample = np.where(at < 1, 100, 0.5)  # the films' own scatter is an eighth of it, with 64 samples
    lacking = scattered(1e-3).results
    films = np.array([result.film for result in lacking]) - 0.99 * value * (at <= 1e-4)
    (group,) = hard.groups(hard.rows(judged_on(
        [DISTANCE], scattered(one_sample / 8, "mc-area"), scattered(0.5 / 8, "mc-solid-angle"),
        given("rare", films, peak=1e12 * value), given("silent", films), given("exact", value[None], deterministic=True))))
    assert hard_spread.sentences(group) == {
        "never above 10 times the exact light": ["mc-solid-angle"],
        "explodes: above 10 times the exact light at a distance to the lamp of 0.1 m and less": ["mc-area"],
        "explodes: above 10 times the exact light at a distance to the lamp of 0.0001 m and less": ["rare"],
        "not to be told at a distance to the lamp of 0.0001 m and less: off by more than films scatter, by light too rare to be"
        " met or missing for good": ["silent"],
    }


def test_the_deviation_of_one_sample_is_that_of_the_films_times_the_root_of_their_samples():
    """Noise of 0.25 of the light in films of 64 samples is one of 2 in a sample; where 1,024 of them miss 0.99 of the light, each
    of those that would bring it is worth 32 x 0.99 at least, and its point is hollow."""
    even = hard_spread.Spread(Deviation(scattered(0.25)))
    assert even.relative.mean() == pytest.approx(2, rel=0.15)
    films = 0.01 * EXACT.value * (1 + 1e-4 * np.arange(16)[:, None])
    lacking = given("lacking", films, peak=1e12 * EXACT.value)
    (group,) = hard.groups(hard.rows(judged_on([DISTANCE], lacking)))
    points = next(rows for rows in hard_charts.spread_along(group, ["lacking"])["datasets"].values() if "method" in rows[0])
    assert all(point["value"] == pytest.approx(32 * 0.99, rel=1e-3) and point["hidden"] for point in points)


@pytest.mark.parametrize("name", [scene.name for scene in CATALOGUE.scenes() if "hard" in scene.tags])
def test_every_sweep_has_its_parameter(name):
    """One positive number a point, of at least three in a sweep's chart."""
    scene = CATALOGUE.scene(name)
    values = sweeps.values(scene)
    assert scene.id in sweeps.TEXTBOOK
    if values is not None:
        assert values.shape == (scene.size,) and (values > 0).all()


@pytest.mark.parametrize(("marked", "said"), [
    ([1, 1, 1, 1], "everywhere"),
    ([1, 1, 0, 0], "at a distance of 0.01 m and less"),
    ([0, 0, 0, 1], "at a distance of 1 m and more"),
    ([1, 0, 1, 0], "at a distance of 0.001 m and less, 0.1 m"),
])
def test_ranges_in_words(marked, said):
    sweep = sweeps.Sweep("distance", "m", lambda scene: np.zeros(4))
    assert hard_findings.ranges(np.array([0.001, 0.01, 0.1, 1]), np.array(marked, bool), sweep) == said
