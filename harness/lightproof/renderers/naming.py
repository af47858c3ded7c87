"""From what a user calls a method to its entry: one that Lightproof knows, or a class, function or manifest of the user's own."""

from __future__ import annotations

import fnmatch
import re
from pathlib import Path

from lightproof.checked import plain
from lightproof.renderers import manifest
from lightproof.renderers.registry import METHODS, Entry, unknown

TARGET = re.compile(r"(?P<where>.+):(?P<name>\w+)(?P<options>/.*)?")


class MethodError(ValueError):
    """A name that no method has: says what would be right."""


def entries(pattern: str) -> list[Entry]:
    """The methods that a pattern names: a name or a glob over names; of the user's own `module:name` or `path/to/file.py:name`, a
    class or function, or the path of a manifest, `renderer.toml`. Raises MethodError, SceneError."""
    if target := TARGET.fullmatch(pattern):
        return [_own(**target.groupdict())]
    if pattern.endswith(".toml"):
        return [_outside(Path(pattern).resolve())]
    if pattern.endswith(".py"):
        raise MethodError(f"{pattern}: name the function or class too, such as {pattern}:render")
    names = fnmatch.filter(METHODS, pattern)
    if not names:
        raise MethodError(unknown(pattern))
    return [METHODS[name] for name in names]


def entry(name: str) -> Entry:
    """The one method that a name is of, as `entries` has it. Raises MethodError, SceneError."""
    found = entries(name)
    if len(found) > 1:
        raise MethodError(f"{name!a} names {len(found)} methods; give one, such as {found[0].name}")
    return found[0]


def _own(where: str, name: str, options: str | None) -> Entry:
    path = Path(where)
    if where.endswith(".py") and not path.is_file():
        raise MethodError(f"{where}: there is no such file; give the path of a Python file, such as my_renderer.py:render")
    stem, where = (path.stem, str(path.resolve())) if where.endswith(".py") else (where, where)
    return Entry(plain(f"{stem}:{name}{options or ''}"), f"{where}:{name}", worker=f"{where}:{name}")


def _outside(path: Path) -> Entry:
    described = manifest.read(path)
    if described.name in METHODS:
        raise MethodError(f"{path}: name: {described.name!r} is a method of Lightproof's own; give the renderer another name")
    return described.entry(path)
