"""The rates that the report holds slopes to are those that the estimators' README prints, and every method of ours has some."""

from __future__ import annotations

from pathlib import Path

import pytest

from lightproof.estimators import rates
from lightproof.estimators.rates import DOMAINS, GRIDS, POINTS
from lightproof.renderers.registry import METHODS, OURS, family

README = (Path(rates.__file__).parent / "README.md").read_text(encoding="utf-8")
ROWS = {line.split(" | ")[0]: line.strip("|\n ").split(" | ") for line in README.splitlines() if line.startswith("| ")}
POINT, ELEMENT = slice(3, 5), slice(1, 3)  # columns of the two tables


@pytest.mark.parametrize(("row", "columns", "expected"), [
    *[(f"| `…/{name}`", POINT, rates.point) for name, rates in POINTS.items() if name != "independent"],
    *[(f"| `{name}`", POINT, GRIDS.get(name, POINTS["independent"]).point) for name in DOMAINS if "projected" not in name],
    *[(f"| {name}", ELEMENT, rates.element) for name, rates in {**POINTS, **GRIDS}.items()],
])
def test_the_readme_prints_the_rates_of_the_code(row, columns, expected):
    assert ROWS[row][columns] == [str(rate) for rate in expected]


def test_every_method_of_ours_samples_something_that_is_named():
    """But the closed forms, well computed or not, which have no error to fall, and cubature, whose rates are its bound's."""
    ours = {family(name) for name, entry in METHODS.items() if entry.worker == OURS}
    assert set(DOMAINS) == ours - {"analytic", "textbook", "cubature"}
    assert set(GRIDS) <= set(DOMAINS)


def test_logarithms_flatten_a_slope():
    """d/d log N of log(N^-3/2 (log N)^3/2) is -3/2 + 3/2 / log N."""
    assert POINTS["sobol"].element[0].slopes(1000) == pytest.approx((-1.5, -1.5 + 1.5 / 6.907755), rel=1e-6)
    assert GRIDS["riemann-area"].point[1].slopes(1000) == (-0.75, -0.5)
