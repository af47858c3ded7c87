"""What to use when, the front that no method beats, and slopes held against theory."""

from __future__ import annotations

from dataclasses import replace

import pytest
import small_run

from lightproof.estimators.rates import GRIDS, POINTS, Rate
from lightproof.reporting import choice, front, theory, wording
from lightproof.reporting.evaluation import Cell, evaluate
from lightproof.reporting.front import Place
from lightproof.reporting.theory import Slope
from lightproof.scene import Scene
from lightproof.scene_file import from_table
from lightproof.verdict import Outcome


@pytest.fixture(scope="module")
def measured(tmp_path_factory) -> dict[str, Cell]:
    """The cells of the floor in a small run, by method."""
    return {cell.method: cell for cell in evaluate(*small_run.make(tmp_path_factory.mktemp("speed"))).cells
            if cell.scene.id == "floor"}


@pytest.fixture
def made(measured):
    """A cell of a method whose films took so many seconds for such errors, step by step."""

    def make(method: str, *films: tuple[float, float], outcome: Outcome = Outcome.PASS) -> Cell:
        source = measured["analytic" if method == "analytic" else "mc-area"]
        steps = tuple(replace(step, seconds_render=seconds, rmse=error)
                      for step, (seconds, error) in zip(source.verdict.steps, films, strict=False))
        return replace(source, method=method, verdict=replace(source.verdict, steps=steps, outcome=outcome))

    return make


def test_the_fastest_of_each_kind(made):
    """analytic is exact in 5 ms; mc-area takes 1 ms to 1 % and Mitsuba 80 ms, between its films by the power law."""
    theirs = made("mitsuba", (0.02, 0.02), (0.32, 0.005))
    cells = [made("analytic", (0.005, 0)), made("mc-area", (0.0001, 0.1), (0.001, 0.01)), theirs]
    chosen = choice.choose(cells, 0.01)
    assert (chosen.fastest.method, chosen.sampling.method, chosen.external.method) == ("mc-area", "mc-area", "mitsuba")
    assert chosen.ratio == pytest.approx(80) and chosen.short == "80 ×"
    assert str(chosen) == "mc-area, 1 ms; ours is 80 times as fast as the fastest external renderer, mitsuba, 80 ms"
    assert str(choice.choose(cells[:1], 0.01)) == "analytic, at most 5 ms; none of ours that sample came so far"


@pytest.mark.parametrize(("ours", "theirs", "short"), [
    ([(0.001, 0.02), (0.004, 0.01)], [(0.4, 0.02), (0.8, 0.01)], "200 ×"),
    ([(0.004, 0.01)], [(0.4, 0.02), (0.8, 0.01)], "≥ 200 ×"),
    ([(0.001, 0.02), (0.004, 0.01)], [(0.8, 0.009)], "≤ 200 ×"),
    ([(0.004, 0.01)], [(0.8, 0.009)], "≈ 200 ×"),
    ([(0.004, 0.01)], [(0.4, 0.2), (0.8, 0.1)], "> 200 ×"),
    ([(0.004, 0.02)], [(0.4, 0.2), (0.8, 0.01)], ""),
    ([(4.0, 0.01)], [(0.8, 0.02)], ""),
])
def test_bounds_are_told_from_times(made, ours, theirs, short):
    """A first film that is better already bounds a time from above, one that never came so far from below."""
    assert choice.choose([made("mc-area", *ours), made("mitsuba", *theirs)], 0.01).short == short


def test_a_renderer_that_is_faster_is_said_to_be(made):
    cells = [made("path", (0.2, 0.02), (0.8, 0.01)), made("cycles", (0.1, 0.02), (0.2, 0.01))]
    assert str(choice.choose(cells, 0.01)) == ("cycles, 200 ms; of ours that sample path, 800 ms; ours is 4 times as slow as the"
                                               " fastest external renderer, cycles, 200 ms")
    assert choice.choose(cells, 0.01).heat < 0


def test_wrong_light_is_never_fast(made):
    """A wrong method is neither chosen nor on a front."""
    cells = [made("mc-area", (0.001, 0.1), (0.004, 0.05)), made("mc-cosine", (1e-6, 0.001), outcome=Outcome.FAIL)]
    assert choice.choose(cells, 0.05).fastest.method == "mc-area"
    assert {place.method for place in front.fronts(cells)[front.ALL]} == {"mc-area"}
    assert str(choice.choose(cells, 0.01)) == "nothing came so far; nearest is mc-area, 5.0 % in 4 ms"


def test_a_run_in_a_sentence(made):
    """On two scenes ours is 10 and 40 times as fast, on a third the ratio is only known from above."""
    theirs = made("mitsuba", (0.05, 0.02), (0.2, 0.01))
    chosen = [choice.choose([made("mc-area", (0.001, 0.02), (time, 0.01)), theirs], 0.01) for time in (0.02, 0.005)]
    chosen.append(choice.choose([made("path", (0.001, 0.02), (0.1, 0.01)), made("mitsuba", (0.2, 0.01))], 0.01))
    assert choice.overall(chosen) == (
        "To 1 %: fastest of all are mc-area on 2, path on 1 of 3 scenes. Ours that sample are 10 to 40 times as fast as the"
        " fastest external renderer, on the 2 scenes where that is known or bounded from below.")


@pytest.mark.parametrize(("value", "said"), [(0.826, "0.83"), (4.19, "4.2"), (99.6, "100"), (1337, "1,340")])
def test_how_many_times(value, said):
    assert wording.multiple(value) == said


def test_the_front_is_what_no_film_beats():
    """A slower film that is no better is not on it, nor one of two that are equal, nor what is better than need be."""
    films = [("a", 1, 0.1), ("b", 2, 0.1), ("c", 3, 0.02), ("a", 4, 0.05), ("b", 5, 0.02), ("c", 9, 0.01)]
    found = front.pareto(Place(*film) for film in reversed(films))
    assert [(place.method, place.seconds) for place in found] == [("a", 1), ("c", 3), ("c", 9)]
    assert front.in_words(found) == "a, 10 % in 1 s; c, 2.0 % in 3 s to 1.0 % in 9 s"


def test_groups_have_fronts_of_their_own(made):
    """That of all is analytic's alone; ours that sample and the renderers have others."""
    renderers = [made("mitsuba", (0.1, 0.01)), made("mine:Own", (0.2, 0.02))]
    cells = [made("analytic", (0.001, 0)), made("mc-area", (0.002, 0.1)), *renderers]
    found = {name: [place.method for place in places] for name, places in front.fronts(cells).items()}
    assert found == {front.ALL: ["analytic"], front.SAMPLING: ["mc-area"], front.EXTERNAL: ["mitsuba"]}


SQUARE = small_run.LIGHT["shape"]["vertices"]
TRIANGLE = {**small_run.LIGHT, "shape": {"type": "polygon", "vertices": SQUARE[:3]}}
CUT = {**small_run.LIGHT, "shape": {"type": "sphere", "center": [0, 0, 0.1], "radius": 0.5}}
SKY = {"id": "sky", "kind": "environment", "radiance": 1.0}
BULB = {"id": "bulb", "kind": "point", "position": [0, 0, 1], "intensity": 1.0}
SHADE = {"id": "shade", "reflectance": 0.0, "shape": {"type": "disk", "center": [0, 0, 0.5], "normal": [0, 0, -1], "radius": 0.2}}


def scene(film: str, *lights: dict, **fields: object) -> Scene:
    table = {"title": "test", "max_bounces": 0, "tolerance": 0.01, "light": list(lights), "film": small_run.FILMS[film]}
    return from_table({**table, **fields}, "test")


def between(smooth: Rate, shadowed: Rate) -> Rate:
    return Rate(shadowed.flattest, smooth.steepest)


SOBOL, JITTER = POINTS["sobol"], POINTS["jitter"]


@pytest.mark.parametrize(("method", "points", "place", "rate"), [
    ("mc-area/sobol", "sobol", scene("spots", small_run.LIGHT), SOBOL.point[0]),
    ("mc-area/sobol-float64", "sobol", scene("floor", small_run.LIGHT), SOBOL.element[0]),
    ("mc-area/sobol", "sobol", scene("spots", small_run.LIGHT, surface=[SHADE]), between(*SOBOL.point)),
    ("mc-area/sobol", "sobol", scene("floor", small_run.LIGHT, surface=[SHADE]), between(*SOBOL.element)),
    ("mc-area/sobol", "sobol", scene("spots", TRIANGLE), between(*SOBOL.point)),
    ("mc-solid-angle/sobol", "sobol", scene("spots", TRIANGLE), SOBOL.point[0]),
    ("mc-solid-angle/sobol", "sobol", scene("spots", CUT), between(*SOBOL.point)),
    ("mc-hemisphere/jitter", "jitter", scene("spots", small_run.LIGHT), between(*JITTER.point)),
    ("mc-hemisphere/jitter", "jitter", scene("spots", SKY), JITTER.point[0]),
    ("mc-area/jitter", "jitter", scene("floor", BULB), JITTER.point[0]),
    ("mc-area/jitter", "jitter", scene("spots", BULB), None),
    ("mc-projected-solid-angle", "independent", scene("spots", {**CUT, "shape": {**CUT["shape"], "center": [0, 0, 2]}}), None),
    ("riemann-area", "", scene("floor", small_run.LIGHT), GRIDS["riemann-area"].element[0]),
    ("path", "independent", scene("view", small_run.LIGHT), POINTS["independent"].point[0]),
    ("analytic", "", scene("floor", small_run.LIGHT), None),
])
def test_theory_goes_by_method_points_and_scene(measured, method, points, place, rate):
    """Smooth at points and over elements; a blocker, a fold, the horizon and a light's outline are edges; bulbs and projected
    spheres leave nothing to sample."""
    source = measured["mc-area"]
    results = tuple(replace(result, settings={"points": points} if points else {}) for result in source.results)
    assert theory.expected(replace(source, method=method, scene=place, results=results)) == rate


def test_of_renderers_theory_knows_independent_samples_alone(measured):
    """The small run's renderer says that its sampler is independent; with another one nothing is known."""
    ours, theirs = POINTS["independent"].point[0], measured[small_run.HOSTILE]
    other = tuple(replace(result, settings={"sampler.type": "SOBOL"}) for result in theirs.results)
    assert theory.expected(theirs) == ours
    assert theory.expected(replace(theirs, results=other)) is None


def test_an_interval_that_excludes_theory_is_marked(measured):
    """mc-area falls by the root of the samples, as theory says of independent ones, and not as Sobol's points should."""
    assert not Slope(measured["mc-area"], POINTS["independent"].point[0]).departs
    wrong = Slope(measured["mc-area"], SOBOL.point[0])
    assert wrong.departs == "flatter" and not wrong.stuck
    assert theory.in_words([wrong]).startswith("0 of 1 slopes agree with theory; mc-area (−0.")
    assert Slope(measured["mc-area"], Rate(GRIDS["riemann-area"].element[1].flattest, GRIDS["riemann-area"].element[1].flattest)
                 ).departs == "steeper"


def test_an_error_that_no_sample_reduces_is_named(measured):
    """path is 0.4 % too bright, more than its noise at the last step; mc-area has nothing but noise."""
    biased, noisy = (Slope(measured[method], SOBOL.point[0]) for method in ("path", "mc-area"))
    assert biased.departs == noisy.departs == "flatter"
    assert str(biased).endswith(", as most of its error is bias or rounding") and not noisy.stuck
