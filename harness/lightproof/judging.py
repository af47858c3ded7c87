"""What the raw results of a run come to: the one place where runner and references meet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from lightproof import ladder, suite, verdict
from lightproof.references import Reference, ReferenceError
from lightproof.runner import Decision
from lightproof.scene import Scene
from lightproof.store import Store
from lightproof.suite import Suite
from lightproof.trial import Result
from lightproof.verdict import Outcome, Verdict


@dataclass(frozen=True)
class Homes(Suite):
    """The suites of a run: each scene's reference is where its scene was found, else (the run may come from another machine)
    in the suite at `root`."""

    homes: Mapping[str, Suite]

    def reference(self, scene: Scene) -> Reference:
        """The exact light of a scene. Raises ReferenceError where it is missing, stale or broken."""
        home = self.homes.get(scene.name)
        return home.reference(scene) if home and home.root.is_dir() else super().reference(scene)


def homes(record: Store) -> Homes:
    """Where the references of a run's scenes are."""
    roots = record.run.options.get("suites", {})
    return Homes(suite.default().root, {name: Suite(Path(root)) for name, root in roots.items()})


class Judge:
    """Judges the results of one run, by the references of `suite` (default: those that stand beside the run's scenes)."""

    def __init__(self, record: Store, suite: Suite | None = None):
        self._scenes = {(scene.id, scene.case): scene for scene in record.scenes}
        self._suite = suite or homes(record)
        options = record.run.options
        self._rule = {"triples": max(ladder.TRIPLES, len(record.scenes) * len(options.get("methods", ()))),
                      "replicates": options.get("replicates", 2)}
        self._counted = options.get("counted", True)
        self._known = cache(self._look_up)

    def scene(self, results: Sequence[Result]) -> Scene:
        """The scene that results are of."""
        return self._scenes[results[0].trial.scene, results[0].trial.case]

    def reference(self, results: Sequence[Result]) -> Reference | None:
        """The exact light that results are judged by, where there is one."""
        return self._known(self.scene(results))[0]

    def judge(self, results: Sequence[Result]) -> Verdict:
        """The verdict of one method on one scene from all its results; where its light is not known, the reason says why."""
        scene = self.scene(results)
        reference, missing = self._known(scene)
        judged = verdict.judge(results, reference, scene, **self._rule)
        judged = judged if self._counted else verdict.uncounted(judged)
        return replace(judged, reason=missing) if judged.outcome is Outcome.NO_REFERENCE else judged

    def decide(self, results: Sequence[Result]) -> Decision:
        """What the runner may know of it."""
        judged = self.judge(results)
        return Decision(judged.outcome is not Outcome.UNDECIDED, judged.samples_needed)

    def _look_up(self, scene: Scene) -> tuple[Reference | None, str]:
        try:
            return self._suite.reference(scene), ""
        except ReferenceError as error:
            return None, str(error)
