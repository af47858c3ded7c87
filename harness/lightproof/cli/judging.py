"""What the raw results of a run come to: the one place where runner and references meet."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path

from lightproof import verdict
from lightproof.reference import Reference, ReferenceError
from lightproof.runner import Decision
from lightproof.scene import Scene
from lightproof.store import Store
from lightproof.suite import Suite
from lightproof.trial import Result
from lightproof.verdict import Outcome, Verdict


class Judge:
    """Judges the results of one run."""

    def __init__(self, store: Store):
        self._scenes = {(scene.id, scene.case): scene for scene in store.scenes}
        self._suites = {name: Suite(Path(root)) for name, root in store.run.options["suites"].items()}
        self._reference = cache(self._read_reference)

    def judge(self, results: Sequence[Result]) -> Verdict:
        """The verdict of one method on one scene from all its results."""
        scene = self._scenes[results[0].trial.scene, results[0].trial.case]
        return verdict.judge(results, self._reference(scene), scene)

    def decide(self, results: Sequence[Result]) -> Decision:
        """What the runner may know of it."""
        judged = self.judge(results)
        return Decision(judged.outcome is not Outcome.UNDECIDED, judged.samples_needed)

    def _read_reference(self, scene: Scene) -> Reference | None:
        try:
            return self._suites[scene.name].reference(scene)
        except ReferenceError:
            return None
