"""From what the command line names to scenes and methods."""

from __future__ import annotations

import fnmatch
import re
from collections.abc import Sequence
from pathlib import Path

from lightproof import scene, suite
from lightproof.checked import plain
from lightproof.cli.status import UsageError, unknown
from lightproof.renderers import manifest
from lightproof.renderers.registry import METHODS, Entry
from lightproof.scene import Scene
from lightproof.scene_file import BASE
from lightproof.suite import Suite

NIGHTLY, QUICK = "nightly", "quick"
TARGET = re.compile(r"(?P<where>.+):(?P<name>\w+)(?P<options>/.*)?")


def methods(patterns: Sequence[str], tags: Sequence[str]) -> list[Entry]:
    """The methods that `patterns` name: names, globs over names, or of the user's own `module:name` and `path/to/file.py:name`
    (classes and functions) and manifests, `path/to/renderer.toml`; without patterns each method's best configuration, or every
    one for the tag nightly. Raises UsageError, SceneError."""
    if not patterns:
        return [entry for entry in METHODS.values() if NIGHTLY in tags or not entry.nightly]
    chosen: dict[str, Entry] = {}
    for entry in (each for pattern in patterns for each in _matching(pattern)):
        if chosen.setdefault(entry.name, entry) != entry:
            raise UsageError(f"two different methods are called {entry.name}; rename the file of one")
    return list(chosen.values())


def _matching(pattern: str) -> list[Entry]:
    if target := TARGET.fullmatch(pattern):
        return [_own(**target.groupdict())]
    if pattern.endswith(".toml"):
        return [_outside(Path(pattern).resolve())]
    if pattern.endswith(".py"):
        raise UsageError(f"{pattern}: name the function or class too, such as {pattern}:render")
    names = fnmatch.filter(METHODS, pattern)
    if not names:
        raise unknown("method", pattern, [*METHODS])
    return [METHODS[name] for name in names]


def _own(where: str, name: str, options: str | None) -> Entry:
    path = Path(where)
    if where.endswith(".py") and not path.is_file():
        raise UsageError(f"{where}: there is no such file; give the path of a Python file, such as my_renderer.py:render")
    stem, where = (path.stem, str(path.resolve())) if where.endswith(".py") else (where, where)
    return Entry(plain(f"{stem}:{name}{options or ''}"), f"{where}:{name}", worker=f"{where}:{name}")


def _outside(path: Path) -> Entry:
    described = manifest.read(path)
    if described.name in METHODS:
        raise UsageError(f"{path}: name: {described.name!r} is a method of Lightproof's own; give the renderer another name")
    return described.entry(path)


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
