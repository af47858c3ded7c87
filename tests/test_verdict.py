"""The verdict's rule, clause by clause, on films whose bias and noise are given.

Unless a test says otherwise: 12 x 16 elements, exact light from 2 to 4 W/m2, tolerance 0.005 of the largest (0.02 W/m2),
16 replicates a step.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from cells import LIGHT, SCENE, error, noisy, reference, results, trial

from lightproof import ladder, suite, verdict
from lightproof.references import Reference
from lightproof.scale import Scale
from lightproof.scene import Scene
from lightproof.trial import Result, Status
from lightproof.verdict import Outcome, Verdict

ROW, COLUMN = np.indices(SCENE.film.grid).reshape(2, -1)
TILE = (ROW // 2 == 3) & (COLUMN // 2 == 5)  # one of the 48 tiles
QUIET, LOUD = 0.01, 0.2  # of an element [W/m2]: tiles' intervals far inside, and far wider than, the tolerance


def judged(steps: dict[int, np.ndarray], exact: Reference | None = None, scene: Scene = SCENE, **fields: object) -> Verdict:
    return verdict.judge(results(steps, scene, **fields), exact or reference(scene=scene), scene)


def outcomes(judged: Verdict) -> list[str]:
    return [step.outcome.value for step in judged.steps]


# Noisy films

def test_the_exact_light_passes():
    """The exact light with little noise: pass at one step."""
    found = judged({64: noisy(LIGHT, QUIET)})
    assert found.outcome is Outcome.PASS
    assert found.samples_needed is None


def test_a_pass_needs_no_confirmation_and_a_fail_does():
    """All elements 3 % of the largest too bright: a vote, then a fail."""
    biased = LIGHT + 0.12
    assert outcomes(judged({64: noisy(biased, QUIET), 256: noisy(biased, QUIET / 2, seed=2)})) == ["undecided", "fail"]


def test_one_vote_is_unconfirmed():
    found = judged({64: noisy(LIGHT + 0.12, QUIET)})
    assert found.outcome is Outcome.UNDECIDED
    assert found.reason.startswith("unconfirmed: the film's mean is off by +3")
    assert found.samples_needed == 256


def test_votes_on_opposite_sides_do_not_confirm():
    """3 % too bright, then 3 % too dark."""
    found = judged({64: noisy(LIGHT + 0.12, QUIET), 256: noisy(LIGHT - 0.12, QUIET, seed=2)})
    assert outcomes(found) == ["undecided", "undecided"]


def test_votes_in_different_places_do_not_confirm():
    """One tile 3 % too bright, at the next step another one; the film's mean stays inside."""
    elsewhere = (ROW // 2 == 0) & (COLUMN // 2 == 1)
    found = judged({64: noisy(LIGHT + 0.12 * TILE, QUIET), 256: noisy(LIGHT + 0.12 * elsewhere, QUIET, seed=2)})
    assert outcomes(found) == ["undecided", "undecided"]


def test_votes_at_steps_that_are_not_consecutive_do_not_confirm():
    """3 % too bright at 64 and 1,024 samples, nothing in between."""
    found = judged({64: noisy(LIGHT + 0.12, QUIET), 1024: noisy(LIGHT + 0.12, QUIET, seed=2)})
    assert outcomes(found) == ["undecided", "undecided"]


def test_one_bad_tile_fails():
    """One tile of 48 is 3 % too dark; the film's mean is inside the tolerance. The reason names the tile."""
    dark = LIGHT - 0.12 * TILE
    found = judged({64: noisy(dark, QUIET), 256: noisy(dark, QUIET / 2, seed=2)})
    assert found.outcome is Outcome.FAIL
    assert found.reason.startswith("the tile of rows 6-7, columns 10-11 is off by -3")
    assert found.steps[-1].worst_tile_bias == pytest.approx(-0.03, abs=0.002)


def test_one_bad_element_forbids_a_pass_and_fails():
    """One element 1.6 % too bright, which its tile dilutes to 0.4 %."""
    spot = LIGHT + 0.064 * ((ROW == 6) & (COLUMN == 10))
    found = judged({64: noisy(spot, QUIET / 4), 256: noisy(spot, QUIET / 8, seed=2)})
    assert outcomes(found) == ["undecided", "fail"]
    assert found.reason.startswith("the element at row 6, column 10 is off by +1.5")


def test_noise_alone_neither_passes_nor_fails():
    """The exact light under noise of 5 % an element: the samples named would let the intervals in."""
    found = judged({64: noisy(LIGHT, LOUD)})
    assert found.outcome is Outcome.UNDECIDED
    assert 64 * 4 < found.samples_needed < 64 * 400
    assert judged({64: noisy(LIGHT, LOUD / np.sqrt(found.samples_needed / 64))}).outcome is Outcome.PASS


def test_samples_needed_is_the_rule_as_stated():
    """N (max_j (q + 3) s_j / (sqrt(R) tolerance))^2 over tiles and mean, q the t quantile for 65 intervals."""
    films = noisy(LIGHT, LOUD)
    tiles = (films / 4).reshape(16, 6, 2, 8, 2).mean(axis=(2, 4)).reshape(16, -1)
    q = -ladder.statistics.stdtrit(15, (1 - (1 - 0.004) ** (1 / 65)) / 2)
    expected = 64 * ((q + 3) * tiles.std(axis=0, ddof=1).max() / (4 * 0.005)) ** 2
    found = judged({64: films})
    assert found.samples_needed == int(np.ceil(expected))
    assert found.reason.endswith(f"; {found.samples_needed:,} samples would decide")


def test_a_bias_at_the_tolerance_needs_the_next_step_at_least():
    """0.49 % too bright, tolerance 0.5 %: noise is far below the tolerance already, yet the intervals cross it."""
    found = judged({64: noisy(LIGHT + 0.0196, QUIET)})
    assert found.outcome is Outcome.UNDECIDED
    assert found.samples_needed == 256


def test_an_interval_too_wide_does_not_vote():
    """Three times too bright, but with noise whose intervals are wider than ten tolerances."""
    bright = 3 * LIGHT
    found = judged({64: noisy(bright, 4), 256: noisy(bright, 4, seed=2)})
    assert found.outcome is Outcome.UNDECIDED
    assert "unconfirmed" not in found.reason


def test_a_tile_without_noise_does_not_vote():
    """Noise everywhere but in one tile, which is 3 % too dark in every replicate: neither pass nor fail, nor any number of
    samples that would decide."""
    films = [np.where(TILE, LIGHT - 0.12, noisy(LIGHT, QUIET, seed=seed)) for seed in (1, 2)]
    found = judged({64: films[0], 256: films[1]})
    assert outcomes(found) == ["undecided", "undecided"]
    assert found.samples_needed is None


def test_a_black_tile_says_that_no_sample_reached_the_light():
    found = judged({64: np.where(TILE, 0, noisy(LIGHT, QUIET))})
    assert found.outcome is Outcome.UNDECIDED
    assert found.reason == "no sample has reached the light in 1 of 48 tiles"


def test_a_small_true_bias_is_a_finding():
    """0.1 % too bright, within the tolerance of 0.5 %, seen at two steps: pass, biased."""
    biased = LIGHT + 0.004
    found = judged({64: noisy(biased, QUIET), 256: noisy(biased, QUIET, seed=2)})
    assert found.outcome is Outcome.PASS
    assert found.biased
    assert found.reason.startswith("biased by +0.09")
    assert not judged({64: noisy(biased, QUIET)}).biased
    assert not judged({64: noisy(LIGHT + 0.004, QUIET), 256: noisy(LIGHT - 0.004, QUIET, seed=2)}).biased
    assert not judged({64: noisy(LIGHT, QUIET), 256: noisy(LIGHT, QUIET, seed=2)}).biased


def test_intervals_are_those_of_the_rule():
    """mean - reference +- (q s / sqrt(R) + U) in fractions of the largest light, U the reference's and half a step."""
    films = noisy(LIGHT + 0.01, QUIET)
    step = judged({64: films}, reference(uncertainty=0.002), quantization=0.004).steps[0]
    means = films.mean(axis=1) / 4
    q = -ladder.statistics.stdtrit(15, (1 - (1 - 0.004) ** (1 / 65)) / 2)
    half = q * means.std(ddof=1) / 4 + 0.006 / 4
    assert step.bias == pytest.approx(means.mean() - LIGHT.mean() / 4)
    assert (step.bias_low, step.bias_high) == pytest.approx((step.bias - half, step.bias + half))
    errors = (films - LIGHT) / 4
    assert step.rmse == pytest.approx(np.sqrt((errors**2).mean()))
    assert step.max_error == pytest.approx(np.abs(errors.mean(axis=0)).max())
    tiles = errors.reshape(16, 6, 2, 8, 2).mean(axis=(2, 4)).reshape(16, -1)
    seen = (q + 3) * max(tiles.std(axis=0, ddof=1).max(), means.std(ddof=1)) / 4 + 0.006 / 4
    assert step.detectable_bias == pytest.approx(seen)


def test_elements_have_a_level_of_their_own():
    """Their quantile is that of 0.001 over 192 elements; tiles and mean keep that of 65 intervals even in a film of one tile."""
    scale = Scale.of(SCENE, reference())
    rung = ladder.climb(results({64: noisy(LIGHT, QUIET)}), SCENE, scale)[0]
    assert rung.quantile[:49] == pytest.approx(ladder.statistics.simultaneous_quantile(0.004, 65, 16))
    assert rung.quantile[49:] == pytest.approx(ladder.statistics.simultaneous_quantile(0.001, 192, 16))


def test_more_triples_widen_the_tiles_intervals():
    """Four times 1,600 triples: the level halves."""
    films = results({64: noisy(LIGHT, QUIET)})
    few, many = (verdict.judge(films, reference(), SCENE, triples=triples).steps[0] for triples in (1600, 6400))
    ratio = ladder.statistics.simultaneous_quantile(0.002, 65, 16) / ladder.statistics.simultaneous_quantile(0.004, 65, 16)
    assert (many.bias_high - many.bias) / (few.bias_high - few.bias) == pytest.approx(ratio, rel=1e-6)
    assert verdict.judge(films, reference(), SCENE, triples=10).steps[0] == few


def test_uncertainty_as_wide_as_the_tolerance_never_passes():
    """Output in steps of 1.2 % of the light: no number of samples decides."""
    found = judged({64: noisy(LIGHT, QUIET)}, quantization=0.024)
    assert found.outcome is Outcome.UNDECIDED
    assert found.samples_needed is None
    assert found.reason.startswith("no number of samples decides: the output's steps leave ±0.6 %")


@pytest.mark.parametrize("grid, index, words", [
    ((12, 16), 0, "the tile of rows 0-1, columns 0-1"), ((12, 16), 47, "the tile of rows 10-11, columns 14-15"),
    ((12, 16), 48, "the film's mean"), ((12, 16), 49 + 17, "the element at row 1, column 1"),
    ((1, 100), 49, "the tile of points 98-99"), ((1, 100), 51 + 7, "point 7"), ((1, 5), 3, "point 3"),
])
def test_places_have_words(grid, index, words):
    """12 x 16 elements in 48 tiles of 2 x 2; 100 points in 50 tiles of 2; 5 points, each its own tile."""
    nothing = np.zeros(grid[0] * grid[1])
    assert Scale(grid, nothing, nothing, nothing).place(index) == words


# The scale of errors

def test_errors_relative_to_each_element():
    """Light over four decades, every element 0.3 % too bright: bias 0.3 % under "element"."""
    scene = replace(SCENE, tolerance_scale="element")
    light = np.logspace(-2, 2, SCENE.size)
    step = judged({64: light * noisy(np.full(SCENE.size, 1.003), 1e-3)}, reference(light, 1e-12), scene).steps[0]
    assert step.bias == pytest.approx(0.003, abs=1e-4)
    assert step.worst_tile_bias == pytest.approx(0.003, abs=1e-3)


def test_an_element_without_light_takes_the_largest_as_its_scale():
    """One element where no light is due shows 0.1 W/m2; the film's largest light is 4."""
    scene = replace(SCENE, tolerance_scale="element")
    dark = np.where(np.arange(SCENE.size) == 7, 0, LIGHT)
    step = judged({64: noisy(dark + 0.1 * (dark == 0), 1e-6)}, reference(dark, 1e-12), scene).steps[0]
    assert step.max_error == pytest.approx(0.1 / 4, rel=1e-3)


def test_errors_in_the_films_unit():
    """Tolerance scale 10 W/m2, all elements 0.03 W/m2 too bright: 0.3 %."""
    scene = replace(SCENE, tolerance_scale=10.0)
    assert judged({64: noisy(LIGHT + 0.03, 1e-3)}, scene=scene).steps[0].bias == pytest.approx(0.003, rel=1e-2)


def test_no_light_at_all_needs_a_scale():
    """An umbra everywhere: the largest light, zero, is no scale; a number is."""
    dark = np.zeros(SCENE.size)
    assert judged({64: noisy(dark, QUIET)}, reference(dark)).outcome is Outcome.ERROR
    scene = replace(SCENE, tolerance_scale=4.0)
    assert judged({64: [dark], 256: [dark]}, reference(dark), scene, deterministic=True).outcome is Outcome.PASS


# Films without noise

def test_a_deterministic_method_passes_at_one_step():
    """0.4 % of the largest off in one element."""
    found = judged({64: [LIGHT + 0.016 * (ROW == 3)]}, deterministic=True)
    assert found.outcome is Outcome.PASS
    assert found.steps[0].replicates == 1


def test_a_deterministic_method_must_be_right_in_every_element():
    """One element 0.6 % off, which its tile dilutes to 0.15 %; half a step of output 0.2 % on top of 0.4 % does the same."""
    spot = (ROW == 6) & (COLUMN == 10)
    assert judged({64: [LIGHT + 0.024 * spot]}, deterministic=True).outcome is Outcome.UNDECIDED
    assert judged({64: [LIGHT + 0.016 * spot]}, deterministic=True, quantization=0.008).outcome is Outcome.UNDECIDED


def test_a_proven_bound_that_does_not_hold_is_an_error():
    """0.4 % of the largest off in one element: within the tolerance, and within a bound of 0.5 %, not within one of 0.3 %."""
    spot = LIGHT + 0.016 * ((ROW == 6) & (COLUMN == 10))
    kept, broken = (judged({64: [spot]}, deterministic=True, bound=np.full(SCENE.size, 4 * share)) for share in (0.005, 0.003))
    assert kept.outcome is Outcome.PASS and kept.reason.endswith("every element within 0.5 % by the method's own proof")
    assert broken.outcome is Outcome.ERROR
    assert broken.reason.startswith("the element at row 6, column 10 is off by +0.4 %, which the method says it proves")
    assert kept.steps[0].bound == pytest.approx(0.005)
    assert judged({64: [spot]}, deterministic=True).steps[0].bound is None


def test_a_deterministic_error_that_stays_fails():
    """3 % off in one tile, the same at two steps."""
    found = judged({64: [LIGHT + 0.12 * TILE], 256: [LIGHT + 0.118 * TILE]}, deterministic=True)
    assert outcomes(found) == ["undecided", "fail"]


def test_a_deterministic_error_that_shrinks_is_undecided():
    """3 % off, then 2 %: it falls to 0.67 of itself."""
    found = judged({64: [LIGHT + 0.12 * TILE], 256: [LIGHT + 0.08 * TILE]}, deterministic=True)
    assert outcomes(found) == ["undecided", "undecided"]
    assert found.reason.startswith("still converging: the tile of rows 6-7, columns 10-11 is off by +2")
    assert found.samples_needed == 1024


def test_a_deterministic_error_on_the_other_side_is_undecided():
    found = judged({64: [LIGHT + 0.12 * TILE], 256: [LIGHT - 0.12 * TILE]}, deterministic=True)
    assert outcomes(found) == ["undecided", "undecided"]


def test_a_sum_that_converges_by_fits_and_starts_is_undecided():
    """Errors of 4 %, then 3.5 %, independent of each other: some elements stay outside on the same side, but the film moves."""
    rng = np.random.default_rng(3)
    found = judged({64: [LIGHT + 0.16 * rng.standard_normal(SCENE.size)], 256: [LIGHT + 0.14 * rng.standard_normal(SCENE.size)]},
                   deterministic=True)
    assert outcomes(found) == ["undecided", "undecided"]


def test_a_sum_that_converges_slowly_is_undecided():
    """Errors that fall to 0.8 of themselves everywhere, as those of a midpoint sum over a light cut by the horizon may."""
    found = judged({64: [LIGHT + 0.15 * TILE], 256: [LIGHT + 0.12 * TILE]}, deterministic=True)
    assert outcomes(found) == ["undecided", "undecided"]


def test_a_deterministic_method_that_aims_past_the_light_is_undecided():
    """A grid of directions so coarse that none meets the light in one tile; a method that aims at lights has no such excuse."""
    missed = np.where(TILE, 0, LIGHT)
    steps = {64: [missed], 256: [missed]}
    assert judged(steps, deterministic=True).outcome is Outcome.UNDECIDED
    assert judged(steps, deterministic=True, samples_lights=True).outcome is Outcome.FAIL


def test_light_that_no_sample_meets_hides_no_convergence():
    """A dark tile outweighs all else; in another the error falls from 3 % to 2.4 %."""
    missed, elsewhere = np.where(TILE, 0, LIGHT), (ROW < 2) & (COLUMN < 2)
    found = judged({64: [missed + 0.12 * elsewhere], 256: [missed + 0.096 * elsewhere]}, deterministic=True)
    assert outcomes(found) == ["undecided", "undecided"]


def test_light_that_one_sample_could_bring_hides_no_convergence():
    """In a block that rare samples may lift, which the film's mean holds too, the error falls from 20 % to 16 %."""
    block = (ROW < 4) & (COLUMN < 4)
    steps = {64: [LIGHT + 4e-6 + 0.8 * block], 256: [LIGHT + 4e-6 + 0.64 * block]}
    found = judged(steps, deterministic=True, samples_lights=True, peak=0.006 * 4 * 256 * block)
    assert outcomes(found) == ["undecided", "undecided"]


def test_a_deterministic_method_whose_films_differ_is_an_error():
    assert judged({64: noisy(LIGHT, QUIET, replicates=2)}, deterministic=True).outcome is Outcome.ERROR


# Seeds

def test_identical_films_count_as_deterministic_once_two_steps_agree():
    """A furnace without noise: 16 identical films a step, and the steps agree."""
    steps = {64: np.tile(LIGHT, (16, 1)), 256: np.tile(LIGHT * (1 + 1e-6), (16, 1))}
    assert outcomes(judged(steps)) == ["undecided", "pass"]
    assert judged({64: steps[64]}).samples_needed == 256
    assert outcomes(judged({samples: 1.1 * films for samples, films in steps.items()})) == ["undecided", "fail"]


def test_identical_black_films_fail_where_the_method_aims_at_lights():
    """A renderer that shows nothing."""
    steps = {samples: np.zeros((16, SCENE.size)) for samples in (64, 256)}
    assert judged(steps, samples_lights=True).outcome is Outcome.FAIL
    assert judged(steps).outcome is Outcome.UNDECIDED


def test_an_ignored_seed_is_an_error():
    """16 identical noisy films at each step, the steps differ by 2e-5 of the largest light."""
    steps = {64: np.tile(LIGHT, (16, 1)), 256: np.tile(LIGHT + 8e-5, (16, 1))}
    found = judged(steps)
    assert found.outcome is Outcome.ERROR
    assert found.reason.startswith("the seed is ignored")


def test_a_repeated_random_stream_is_an_error():
    """Two of 16 films are the same."""
    films = noisy(LIGHT, QUIET)
    films[9] = films[4]
    found = judged({64: films})
    assert found.outcome is Outcome.ERROR
    assert found.reason.startswith("repeated random stream")


# Steps and results

def test_an_incomplete_step_is_listed_but_not_judged():
    """16 films at 64 samples, 15 of them at 256: the verdict is that of 64."""
    biased = LIGHT + 0.12
    found = judged({64: noisy(biased, QUIET), 256: noisy(biased, QUIET, replicates=15, seed=2)})
    assert outcomes(found) == ["undecided", "undecided"]
    assert found.steps[1].message == "15 of 16 replicates"
    assert found.reason.startswith("unconfirmed")
    assert judged({64: noisy(LIGHT, QUIET), 256: noisy(biased, QUIET, replicates=1)}).outcome is Outcome.PASS


def test_an_incomplete_step_does_not_confirm():
    """Ten films at 64 samples, 16 at 256, all 3 % too bright."""
    biased = LIGHT + 0.12
    found = judged({64: noisy(biased, QUIET, replicates=10), 256: noisy(biased, QUIET, seed=2)})
    assert outcomes(found) == ["undecided", "undecided"]


def test_a_single_noisy_film_is_not_judged():
    """One film has no spread."""
    found = judged({64: noisy(LIGHT, QUIET, replicates=1)})
    assert found.outcome is Outcome.UNDECIDED
    assert np.isnan(found.steps[0].bias_low)
    assert found.steps[0].rmse > 0


def test_order_and_repetition_of_results_change_nothing():
    """Results in any order, some recorded twice, one with an error beside its film: the same verdict."""
    films = results({64: noisy(LIGHT + 0.12, QUIET), 256: noisy(LIGHT + 0.12, QUIET, seed=2)})
    shuffled = [*films[::-1], *films[:20], error(64, "crashed", replicate=3)]
    assert verdict.judge(shuffled, reference(), SCENE) == verdict.judge(films, reference(), SCENE)


def test_an_error_prevents_an_undecided_verdict():
    """A crash at the second step: what was measured stays."""
    films = results({64: noisy(LIGHT, LOUD)})
    errors = [error(256, "killed after 60 s", replicate) for replicate in range(2)]
    found = verdict.judge([*films, *errors], reference(), SCENE)
    assert found.outcome is Outcome.ERROR
    assert found.reason == "256 samples, replicate 0: killed after 60 s (and 1 more like it)"
    assert outcomes(found) == ["undecided"]


def test_an_error_after_a_decision_changes_nothing():
    films = results({64: noisy(LIGHT, QUIET)})
    assert verdict.judge([*films, error(256, "killed after 60 s")], reference(), SCENE).outcome is Outcome.PASS


def test_a_step_with_an_error_is_not_complete():
    """15 good films and a crash."""
    films = results({64: noisy(LIGHT, QUIET, replicates=15)})
    assert verdict.judge([*films, error(64, "crashed", replicate=15)], reference(), SCENE).outcome is Outcome.ERROR


@pytest.mark.parametrize("film, problem", [(np.ones(5), "shape (5,)"), (np.where(TILE, np.nan, LIGHT), "4 of the film's 192")])
def test_a_film_that_cannot_be_judged_is_an_error(film, problem):
    found = judged({64: [film]}, deterministic=True)
    assert found.outcome is Outcome.ERROR
    assert problem in found.reason


def test_a_film_of_another_version_of_the_scene_is_an_error():
    old = results({64: noisy(LIGHT, QUIET)})
    old = [replace(result, trial=replace(result.trial, scene_digest="another")) for result in old]
    assert "another version of the scene" in verdict.judge(old, reference(), SCENE).reason


def test_unsupported_says_why():
    refusal = Result(trial(64), Status.UNSUPPORTED, message="pyrender has no area lights")
    for exact in (reference(), None):
        found = verdict.judge([refusal], exact, SCENE)
        assert (found.outcome, found.reason) == (Outcome.UNSUPPORTED, "pyrender has no area lights")


def test_without_a_reference_there_is_no_verdict_but_an_error_is_one():
    assert verdict.judge(results({64: noisy(LIGHT, QUIET)}), None, SCENE).outcome is Outcome.NO_REFERENCE
    assert verdict.judge([error(64, "crashed")], None, SCENE).outcome is Outcome.ERROR


def test_nothing_measured_is_undecided():
    assert verdict.judge([], reference(), SCENE).outcome is Outcome.UNDECIDED


def test_results_of_several_methods_are_refused():
    films = results({64: noisy(LIGHT, QUIET)})
    other = replace(films[0], trial=replace(films[0].trial, method="other"))
    with pytest.raises(ValueError, match="several methods"):
        verdict.judge([*films, other], reference(), SCENE)


def test_seconds_are_medians_and_memory_the_most():
    """Three films in 1, 2 and 9 s with 10, 30 and 20 MB."""
    films = [replace(result, seconds={"render": seconds}, peak_memory_mb=memory) for result, seconds, memory
             in zip(results({64: noisy(LIGHT, QUIET, replicates=3)}), (1, 2, 9), (10, 30, 20), strict=True)]
    step = verdict.judge(films, reference(), SCENE).steps[0]
    assert (step.seconds_setup, step.seconds_render, step.peak_memory_mb) == (0, 2, 30)


def test_a_failing_film_names_its_mistake():
    """pi times too bright."""
    found = judged({64: noisy(np.pi * LIGHT, QUIET), 256: noisy(np.pi * LIGHT, QUIET, seed=2)})
    assert found.outcome is Outcome.FAIL
    assert found.reason.endswith("likely mistake: a factor of pi")


@pytest.mark.parametrize("name", ["disk-light:axis", "square-light-seen", "white-furnace-plane"])
def test_every_kind_of_film_is_judged(name):
    """Points, a camera's image, a furnace: the exact light passes, 10 % more fails."""
    scene = suite.default().scene(name)
    light = np.linspace(2, 4, scene.size)
    for factor, expected in ((1, Outcome.PASS), (1.1, Outcome.FAIL)):
        steps = {64: noisy(factor * light, 1e-3), 256: noisy(factor * light, 1e-3, seed=2)}
        assert judged(steps, reference(light, 1e-9, scene), scene).outcome is expected
