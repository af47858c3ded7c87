"""Classic mistakes are caught: each broken estimator is shown as `fail` by the whole chain, from worker to verdict."""

from __future__ import annotations

from pathlib import Path

import pytest

from lightproof import store
from lightproof.cli import main
from lightproof.judging import Judge
from lightproof.verdict import Outcome

BROKEN = Path(__file__).parent / "broken.py"


@pytest.mark.parametrize(("mistake", "scene", "named"), [
    ("PiForgotten", "square-light", "1/pi"),
    ("CosineForgotten", "square-light", ""),
    ("VisibilityForgotten", "occluded-square", "shadow"),
])
def test_a_broken_estimator_fails(mistake, scene, named, tmp_path):
    """The mistake's factor or missing shadow is far outside half a per cent: fail at two steps, and named where it can be."""
    assert main(["run", scene, "--with", f"{BROKEN}:{mistake}", "--budget", "60", "--out", str(tmp_path), "--strict"]) == 1
    record = store.latest(tmp_path)
    verdict = Judge(record).judge(record.results())
    assert verdict.outcome is Outcome.FAIL
    assert named in verdict.reason


def test_the_same_estimator_unbroken_passes(tmp_path):
    """Else the test above would prove nothing."""
    for scene in ("square-light", "occluded-square"):
        assert main(["run", scene, "--with", "mc-area", "--budget", "60", "--out", str(tmp_path), "--strict"]) == 0
