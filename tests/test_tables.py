"""results.csv and summary.csv say what the raw results say."""

from __future__ import annotations

import csv
import math

import numpy as np
import pandas as pd
import pytest
import small_run

from lightproof.reporting import tables
from lightproof.reporting.evaluation import Evaluation, evaluate

RESULTS = """run, scene, case, method, version, settings, precision, threads, machine, seed, samples, replicates, outcome,
bias, bias_low, bias_high, worst_tile_bias, worst_tile_low, worst_tile_high, detectable_bias, tolerance, rmse, max_error,
bound, tessellation, seconds_setup, seconds_compile, seconds_render, samples_per_second, peak_memory_mb, message"""
SUMMARY = """scene, case, method, outcome, samples, bias, bias_low, bias_high, detectable_bias, tolerance,
seconds_to_1_percent, seconds_to_0_1_percent, seconds_to_0_01_percent, slope, efficiency, message"""


@pytest.fixture(scope="module")
def evaluation(tmp_path_factory) -> Evaluation:
    return evaluate(*small_run.make(tmp_path_factory.mktemp("tables")))


@pytest.fixture(scope="module")
def written(evaluation, tmp_path_factory) -> dict[str, pd.DataFrame]:
    folder = tmp_path_factory.mktemp("csv")
    read = {}
    for name in ("results", "summary"):
        getattr(tables, name)(evaluation).to_csv(folder / f"{name}.csv", index=False)
        read[name] = pd.read_csv(folder / f"{name}.csv", keep_default_na=False, na_values=[""])
    return read


def row(table: pd.DataFrame, scene: str, method: str, step: int = 0) -> pd.Series:
    return table[(table.scene == scene) & (table.method == method)].iloc[step]


def test_the_columns_are_the_documented_ones(written):
    for name, columns in (("results", RESULTS), ("summary", SUMMARY)):
        assert ", ".join(written[name].columns) == columns.replace("\n", " ")


def test_a_row_for_each_step_and_one_where_there_is_none(written):
    """Five methods with four steps, two without any, on three scenes."""
    assert len(written["results"]) == 3 * (5 * 4 + 2)
    assert len(written["summary"]) == 3 * 7


def test_numbers_are_those_of_the_verdict_to_the_last_digit(evaluation, tmp_path):
    """A number read back from the file is the very binary64 that was judged."""
    tables.results(evaluation).to_csv(tmp_path / "results.csv", index=False)
    with (tmp_path / "results.csv").open(encoding="utf-8", newline="") as lines:
        rows = [row for row in csv.DictReader(lines) if row["samples"]]
    steps = [step for cell in evaluation.cells for step in cell.verdict.steps]
    for read, step in zip(rows, steps, strict=True):
        assert (int(read["samples"]), read["outcome"]) == (step.samples, step.outcome)
        numbers = [float(read[name]) for name in ("bias", "worst_tile_high", "rmse", "seconds_render")]
        assert numbers == [step.bias, step.worst_tile_high, step.rmse, step.seconds_render]


def test_a_method_without_a_film_has_empty_numbers_and_its_reason(written):
    """pyrender refuses the floor: no number, but the reason."""
    read = row(written["results"], "floor", "pyrender")
    assert (read.outcome, read.message) == ("unsupported", small_run.REFUSAL)
    assert read[["samples", "replicates", "bias", "rmse", "seconds_render", "samples_per_second"]].isna().all()
    assert row(written["summary"], "floor", "pyrender")[["samples", "slope", "efficiency", "seconds_to_1_percent"]].isna().all()


def test_what_triangles_change_is_told_apart_from_what_is_known(written):
    """Up to 2e-4 of the film's largest value for path, not known for mc-cosine, and mc-area has no triangles."""
    values = [row(written["results"], "floor", method).tessellation for method in ("path", "mc-cosine", "mc-area")]
    np.testing.assert_allclose(values, [2e-4, np.inf, np.nan], rtol=1e-6)


def test_samples_per_second_counts_every_element(written):
    """A film of n elements takes N n / 10^6 seconds: 10^6 samples a second at every step."""
    rates = written["results"].samples_per_second.dropna()
    assert np.allclose(rates, small_run.SAMPLES_PER_SECOND)


def test_independent_samples_have_slope_minus_a_half(written):
    """mc-area on the floor: noise falls as one over the root of the samples."""
    assert row(written["summary"], "floor", "mc-area").slope == pytest.approx(-0.5, abs=0.03)


def test_time_to_an_error_is_that_of_the_samples_it_takes(written):
    """rms error 0.1/sqrt(N): 1 % at N = 100, 0.1 % at N = 10,000, beyond the 4,096 measured."""
    read = row(written["summary"], "floor", "mc-area")
    assert read.seconds_to_1_percent == pytest.approx(100 * 48 / small_run.SAMPLES_PER_SECOND, rel=0.1)
    assert math.isnan(read.seconds_to_0_1_percent) and math.isnan(read.seconds_to_0_01_percent)


def test_an_exact_film_is_at_every_error_with_its_first_step(written):
    """analytic on the floor: 64 x 48 samples, whatever the error."""
    read = row(written["summary"], "floor", "analytic")
    assert read.seconds_to_1_percent == read.seconds_to_0_01_percent == 64 * 48 / small_run.SAMPLES_PER_SECOND


def test_efficiency_is_one_over_variance_times_seconds(written):
    """Variance (0.1)^2/N in N n / 10^6 seconds: 10^6 / (0.01 n), whatever N."""
    assert row(written["summary"], "floor", "mc-area").efficiency == pytest.approx(1e6 / (0.01 * 48), rel=0.15)
    assert math.isnan(row(written["summary"], "floor", "analytic").efficiency)


@pytest.mark.parametrize(("method", "outcome"),
                         [("analytic", "pass"), ("mc-area", "pass"), ("mc-cosine", "fail"), ("cycles", "error")])
def test_the_final_verdict(written, method, outcome):
    """Exact and unbiased films pass, one too bright by pi fails, a crash is an error."""
    assert row(written["summary"], "floor", method).outcome == outcome


def test_counts_are_whole_numbers(evaluation, tmp_path):
    """Rows without samples do not turn the others' 64 into 64.0."""
    tables.summary(evaluation).to_csv(tmp_path / "summary.csv", index=False)
    samples = pd.read_csv(tmp_path / "summary.csv", dtype=str).samples.dropna()
    assert set(samples) == {"4096"}


def test_foreign_text_is_harmless_on_one_line(written):
    """Control characters, a direction mark and a lone surrogate in a renderer's last words are spelt out."""
    message = row(written["summary"], "floor", "cycles").message
    assert "\\x1b[31m" in message and "\\u202e" in message and "\\udcff" in message and message.isprintable()
