"""Find and load the scenes and references of a suite: the checkout's, an installed copy's, or a folder of the user's."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from lightproof import references, scene_file
from lightproof.checked import SceneError, shown
from lightproof.references import Reference
from lightproof.scene import Scene


@dataclass(frozen=True)
class Suite:
    """A folder with scenes/ and references/."""

    root: Path

    @cached_property
    def ids(self) -> tuple[str, ...]:
        """The ids of all scenes, sorted. Raises SceneError where the folder holds none."""
        ids = tuple(sorted(path.stem for path in (self.root / "scenes").glob("*.toml")))
        if not ids:
            raise SceneError(str(self.root), "is no suite: it needs a folder scenes/ with at least one .toml file")
        return ids

    def cases(self, scene_id: str) -> dict[str, Scene]:
        """Every case of one scene, the base first. Raises SceneError."""
        if scene_id not in self.ids:
            known = ", ".join(self.ids)
            raise SceneError("", f"there is no scene {shown(scene_id)}; give one of {known}, or the path of a .toml file")
        return scene_file.read_cases(self.root / "scenes" / f"{scene_id}.toml")

    def scene(self, name: str) -> Scene:
        """One scene by `id` or `id:case`. Raises SceneError."""
        scene_id, _, case = name.partition(":")
        return pick(self.cases(scene_id), case)

    def scenes(self) -> list[Scene]:
        """Every case of every scene."""
        return [scene for scene_id in self.ids for scene in self.cases(scene_id).values()]

    def reference(self, scene: Scene) -> Reference:
        """The exact light of a scene. Raises ReferenceError where it is missing, stale or broken."""
        return references.read(self.root / "references", scene)


def pick(cases: dict[str, Scene], case: str) -> Scene:
    """One case, the base where `case` is empty. Raises SceneError on an unknown one."""
    case = case or scene_file.BASE
    if case not in cases:
        raise SceneError("", f"there is no case {shown(case)}; the cases are {', '.join(cases)}")
    return cases[case]


def default() -> Suite:
    """The checkout's suite where this is one, else the copy that the installed package carries."""
    checkout = Path(__file__).resolve().parents[2]
    return Suite(checkout if (checkout / "scenes").is_dir() else Path(__file__).resolve().parent / "suite")


def find(name: str, suite: Suite) -> tuple[Scene, Suite]:
    """A scene by `id[:case]` in `suite`, or by the path `FILE.toml[:case]` of a user's file, whose references stand in
    the sibling folder references/ of the folder it is in. Raises SceneError."""
    path, _, case = name.partition(".toml")
    if not name.endswith(".toml") and ".toml:" not in name:
        return suite.scene(name), suite
    file = Path(path + ".toml")
    return pick(scene_file.read_cases(file), case.removeprefix(":")), Suite(file.resolve().parent.parent)
