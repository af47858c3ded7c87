"""For pytest: a fixture that judges a renderer, and a marker that runs a test only if nothing has become worse.

    def test_light(lightproof):
        lightproof.check(render, "occluded-square")

See `checking.check` for what it takes: a function (scene, samples, seed) -> film, a film, or a method's name.

    @pytest.mark.lightproof_gate(scenes=["square-light"], methods=["mc-*"])
    def test_nothing_is_worse(): ...

`scenes` and `methods` are globs over the baseline's rows (default: all), `baseline` its path (default: reports/baseline.csv
in the folder that pytest was started from).
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType

import pytest

MARK = "lightproof_gate"


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker known."""
    config.addinivalue_line("markers", f"{MARK}(scenes, methods, baseline): fail if these rows became worse than the baseline")


@pytest.fixture(scope="session")
def lightproof() -> ModuleType:
    """`lightproof.check(renderer or film, scene)` fails the test where the light is not right, and says why."""
    from lightproof import checking

    return checking


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_call(item: pytest.Item) -> None:
    """Judge the marked rows before the test's own body; anything that is not as good as the baseline fails the test."""
    mark = item.get_closest_marker(MARK)
    if mark:
        unknown = set(mark.kwargs) - {"scenes", "methods", "baseline"}
        if mark.args or unknown:
            raise pytest.UsageError(f"{MARK} takes scenes=[...], methods=[...] and baseline='...', nothing else")
        complaints = worse(item.config.invocation_params.dir, **mark.kwargs)
        if complaints:
            pytest.fail("\n".join(complaints), pytrace=False)


def worse(folder: Path, scenes: Sequence[str] = (), methods: Sequence[str] = (),
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
