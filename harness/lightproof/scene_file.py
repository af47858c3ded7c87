"""From a TOML file, or the table that it parses to, to a Scene; errors name file, field and what would be right."""

from __future__ import annotations

import copy
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from lightproof import checked, scene
from lightproof.checked import SceneError
from lightproof.scene import Scene

BASE = "base"
MAX_BYTES = 1 << 20
MOST_PARTS = 32  # of a dotted key: tomllib takes minutes over thousands
KEY_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
LONG_KEY = re.compile(rf"(?<![\w-]){KEY_PART}(?:[ \t]*+\.[ \t]*+{KEY_PART}){{{MOST_PARTS}}}")
LIGHTS = {"area": scene.AreaLight, "point": scene.PointLight, "directional": scene.DirectionalLight,
          "environment": scene.Environment}
FILMS = {"plane": scene.PlaneFilm, "points": scene.PointsFilm, "camera": scene.CameraFilm}
TOP = ("title", "tests", "tags", "max_bounces", "tolerance", "tolerance_scale", "light", "surface", "film")


def read_cases(path: Path) -> dict[str, Scene]:
    """Every case of a scene file, the base first. Raises SceneError, which names the file, on anything broken."""
    try:
        table = read_table(path, "scene")
        cases = table.pop("cases", {})
        if not isinstance(cases, dict):
            raise SceneError("cases", 'give a table for each case, such as [cases.far]')
        name = checked.to_kebab(path.stem)
        read = {BASE: from_table(table, name, BASE)}
        for case, changes in cases.items():
            read[case] = _read_case(table, name, case, changes)
        return read
    except SceneError as error:
        raise SceneError(str(path), str(error)) from None


def _read_case(table: dict[str, Any], name: str, case: str, changes: Any) -> Scene:
    try:
        if checked.to_kebab(case) == BASE:
            raise SceneError("", "is what the file itself is called; give the case another name")
        if not isinstance(changes, dict):
            raise SceneError("", "give a table of fields to replace")
        return from_table(_replaced(table, changes), name, case)
    except SceneError as error:
        raise error.within(f"cases.{case}") from None


def read_table(path: Path, what: str) -> dict[str, Any]:
    """The table of a TOML file that is to hold a `what`, such as "scene". Raises SceneError where it is none, or too large."""
    try:
        if path.exists() and not path.is_file():
            raise SceneError("", f"is no file; give the path of a {what} file (.toml)")
        if path.stat().st_size > MAX_BYTES:
            raise SceneError("", f"the file is larger than {MAX_BYTES} bytes; a {what} is a small text")
        text = path.read_text(encoding="utf-8")
        if LONG_KEY.search(text):
            raise SceneError("", f"holds a key of more than {MOST_PARTS} parts; no {what} has one")
        return tomllib.loads(text)
    except SceneError:
        raise
    except OSError as error:
        raise SceneError("", f"cannot be read: {error.strerror}; give the path of a {what} file (.toml)") from None
    except UnicodeDecodeError as error:
        raise SceneError("", f"is not UTF-8 text (byte {error.start}); a {what} file is TOML") from None
    except (ValueError, RecursionError) as error:
        raise SceneError("", f"is not TOML: {error}") from None


def from_table(table: dict[str, Any], scene_id: str, case: str = BASE) -> Scene:
    """A Scene from its table (as `Scene.to_table` gives it); raises SceneError."""
    checked.only(table, TOP, required=("title", "max_bounces", "tolerance", "film"))
    read = Scene(
        id=checked.to_kebab(scene_id),
        case=checked.to_kebab(case),
        title=_field(table, "title", checked.to_text),
        tests=_field(table, "tests", checked.to_text, ""),
        tags=_field(table, "tags", _tags, ()),
        lights=_items(table, "light", _light),
        surfaces=_items(table, "surface", scene.Surface.from_table),
        film=_field(table, "film", lambda film: checked.by_tag(film, "kind", FILMS).from_table(film)),
        max_bounces=_field(table, "max_bounces", _bounces),
        tolerance=_field(table, "tolerance", _positive),
        tolerance_scale=_field(table, "tolerance_scale", _scale, "max"),
    )
    if not read.lights and not any(surface.radiance for surface in read.surfaces):
        raise SceneError("light", "nothing shines; give a light, or a surface with a radiance of its own")
    return read


def _field(table: dict[str, Any], key: str, read: Callable[[Any], Any], default: Any = None) -> Any:
    if key not in table:
        return default
    try:
        return read(table[key])
    except SceneError as error:
        raise error.within(key) from None


def _items(table: dict[str, Any], key: str, read: Callable[[Any], Any]) -> tuple[Any, ...]:
    items = table.get(key, [])
    if not isinstance(items, list):
        raise SceneError(key, f"give an array of tables, [[{key}]]")
    built = []
    for index, item in enumerate(items):
        label = item.get("id", index) if isinstance(item, dict) else index
        try:
            built.append(read(item))
        except SceneError as error:
            raise error.within(f"{key}.{label if isinstance(label, str) and label.isprintable() else index}") from None
    return tuple(built)


def _light(item: Any) -> scene.Light:
    cls = checked.by_tag(item, "kind", LIGHTS)
    if cls is scene.Environment:
        cls = scene.SunDisc if "half_angle" in item else scene.OvercastSky if "sky" in item else cls
    return cls.from_table(item)


def _positive(value: Any) -> float:
    value = checked.to_number(value)
    if value <= 0:
        raise SceneError("", f"{value:g} is out of range; it must be greater than 0")
    return value


def _scale(value: Any) -> str | float:
    return value if value in ("max", "element") else _positive(value)


def _bounces(value: Any) -> int | str:
    return value if value == "all" else checked.to_count(value)


def _tags(value: Any) -> tuple[str, ...]:
    if not isinstance(value, list) or any(tag not in scene.TAGS for tag in value):
        raise SceneError("", f"{checked.shown(value)} is not accepted; give a list of {', '.join(scene.TAGS)}")
    return tuple(value)


def _replaced(table: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """A copy of the base table with fields replaced, each named by a dotted path such as light.lamp.radiance."""
    table = copy.deepcopy(table)
    for path, value in changes.items():
        *parents, last = path.split(".")
        place: Any = table
        for name in parents:
            place = _step(place, name, path)
        if not isinstance(place, dict):
            raise SceneError(checked.shown(path)[1:-1], "names no field; give a path such as light.<id>.radiance or film.origin")
        place[last] = value
    return table


def _step(place: Any, name: str, path: str) -> Any:
    if isinstance(place, dict) and name in place:
        return place[name]
    if isinstance(place, list):
        for item in place:
            if isinstance(item, dict) and item.get("id") == name:
                return item
    raise SceneError(checked.shown(path)[1:-1], f"there is no {checked.shown(name)} in the base scene")
