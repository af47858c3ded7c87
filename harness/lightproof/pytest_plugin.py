"""The gate for pytest: a marked test runs only if nothing that the baseline accepts has become worse.

    @pytest.mark.lightproof_gate(scenes=["square-light"], methods=["mc-*"])
    def test_light(): ...

`scenes` and `methods` are globs over the baseline's rows (default: all), `baseline` its path (default: reports/baseline.csv
in the folder that pytest was started from).
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

import pytest

MARK = "lightproof_gate"


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker known."""
    config.addinivalue_line("markers", f"{MARK}(scenes, methods, baseline): fail if these rows became worse than the baseline")


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_call(item: pytest.Item) -> None:
    """Judge the marked rows before the test's own body; anything that is not as good as the baseline fails the test."""
    mark = item.get_closest_marker(MARK)
    if mark:
        unknown = set(mark.kwargs) - {"scenes", "methods", "baseline"}
        if mark.args or unknown:
            raise pytest.UsageError(f"{MARK} takes scenes=[...], methods=[...] and baseline='...', nothing else")
        complaints = check(item.config.invocation_params.dir, **mark.kwargs)
        if complaints:
            pytest.fail("\n".join(complaints), pytrace=False)


def check(folder: Path, scenes: Sequence[str] = (), methods: Sequence[str] = (),
          baseline: str = "reports/baseline.csv") -> list[str]:
    """What the gate has against the chosen rows of a baseline. Raises BaselineError, SceneError."""
    from lightproof import baseline as accepted_state
    from lightproof import machine, suite
    from lightproof.gate import Gate

    rows = accepted_state.select(accepted_state.read(folder / baseline), scenes, methods)
    if not rows:
        return [f"{baseline} has no row for scenes {list(scenes)} and methods {list(methods)}"]
    with tempfile.TemporaryDirectory() as state:
        report = Gate(suite.default(), Path(state), machine.usable_cores()).check(rows)
    undecided = [f"{row.name}: {row.outcome}" for row in report.undecided]
    return [*(finding.message for finding in report.findings), *undecided, *report.missing]
