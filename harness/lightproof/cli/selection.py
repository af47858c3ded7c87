"""From what the command line names to scenes and methods."""

from __future__ import annotations

from collections.abc import Sequence

from lightproof import scene, suite
from lightproof.cli.status import UsageError, unknown
from lightproof.renderers import naming
from lightproof.renderers.registry import METHODS, Entry
from lightproof.scene import Scene
from lightproof.scene_file import BASE
from lightproof.suite import Suite

NIGHTLY, QUICK = "nightly", "quick"


def methods(patterns: Sequence[str], tags: Sequence[str]) -> list[Entry]:
    """The methods that `patterns` name, as `naming.entries` has it; without patterns each method's best configuration, or every
    one for the tag nightly. Raises UsageError, MethodError, SceneError."""
    if not patterns:
        return [entry for entry in METHODS.values() if NIGHTLY in tags or not entry.nightly]
    chosen: dict[str, Entry] = {}
    for entry in (each for pattern in patterns for each in naming.entries(pattern)):
        if chosen.setdefault(entry.name, entry) != entry:
            raise UsageError(f"two different methods are called {entry.name}; rename the file of one")
    return list(chosen.values())


def scenes(names: Sequence[str], tags: Sequence[str], root: Suite) -> dict[Scene, Suite]:
    """The scenes that `names` and `tags` choose, each with the suite that holds its reference.

    `names` are ids (the base case), `id:case` or paths of scene files. Without names it is the base case of every scene that
    carries one of the tags, or every case of every scene for the tag nightly; without tags too, of every quick scene, or of
    all where the suite calls none quick. Raises UsageError, SceneError.
    """
    check_tags(tags)
    found = dict(_find(name, root) for name in names) if names else {each: root for each in root.scenes()}
    quick = not names and not tags and any(QUICK in each.tags for each in found)
    wanted = {QUICK} if quick else set(tags) - {NIGHTLY}
    kept = {each: home for each, home in found.items() if (not wanted or wanted & set(each.tags)) and _due(each, names, tags)}
    if not kept:
        raise UsageError(f"no scene carries the tag {' or '.join(sorted(wanted))}; 'lightproof list' shows the tags of each")
    _check_names(list(kept))
    return kept


def check_tags(tags: Sequence[str]) -> None:
    """Raises UsageError where nobody knows a tag."""
    for tag in tags:
        if tag not in scene.TAGS:
            raise unknown("tag", tag, scene.TAGS)


def _due(each: Scene, names: Sequence[str], tags: Sequence[str]) -> bool:
    return bool(names) or NIGHTLY in tags or (each.case == BASE and NIGHTLY not in each.tags)


def _find(name: str, root: Suite) -> tuple[Scene, Suite]:
    scene_id = name.partition(":")[0]
    if ".toml" not in name and scene_id not in root.ids:
        raise unknown("scene", scene_id, root.ids)
    return suite.find(name, root)


def _check_names(chosen: Sequence[Scene]) -> None:
    names = [each.name for each in chosen]
    for name in {name for name in names if names.count(name) > 1}:
        raise UsageError(f"two different scenes are called {name}; rename the file of one")
