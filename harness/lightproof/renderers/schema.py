"""The JSON Schema of the protocol, made from the types themselves: `python -m lightproof.renderers.schema` prints it.

It says of each field what JSON Schema can say; that a polygon is planar, or that an answer is to the job, it cannot.
"""

from __future__ import annotations

import dataclasses
import inspect
import json
from typing import Any

from lightproof import geometry, scene, scene_file
from lightproof.checked import KEBAB_CASE, Checked
from lightproof.renderers import fields, manifest, protocol

MESSAGES = (protocol.Job, protocol.FilmFile, protocol.Rendered, protocol.Seconds, protocol.Declined)
MANIFEST = (manifest.Manifest, manifest.Supports)
KEBAB = {"type": "string", "pattern": f"^{KEBAB_CASE.pattern}$"}


def whole() -> dict[str, Any]:
    """The schema of a job or an answer; `$defs` holds everything that they are made of, and the manifest."""
    lights, films, shapes = manifest.LIGHTS.values(), scene_file.FILMS.values(), geometry.SHAPES.values()
    objects = {fields.def_name(cls): of(cls) for cls in (*MESSAGES, *MANIFEST, *lights, *films, scene.Surface, *shapes)}
    unions = {"light": lights, "film": films, "shape": shapes, "answer": (protocol.Rendered, protocol.Declined)}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"Lightproof's protocol for renderers, version {protocol.VERSION}",
        "oneOf": [to("job"), to("answer")],
        "$defs": {**objects, **{name: union(*classes) for name, classes in unions.items()}, "scene": table_of_scene()},
    }


def of(cls: type[Checked]) -> dict[str, Any]:
    """The schema of one type, its docstring the description."""
    tag = {cls.TAG[0]: {"const": cls.TAG[1]}} if cls.TAG else {}
    required = [field.name for field in dataclasses.fields(cls) if field.default is dataclasses.MISSING]
    return {
        "description": " ".join(inspect.getdoc(cls).split()),
        "type": "object",
        "properties": {**tag, **{field.name: _with_default(field) for field in dataclasses.fields(cls)}},
        "required": [*tag, *required],
        "additionalProperties": False,
    }


def _with_default(field: dataclasses.Field[Any]) -> dict[str, Any]:
    plain = isinstance(field.default, bool | int | float | str)
    return {**field.metadata["schema"], "default": field.default} if plain else field.metadata["schema"]


def union(*classes: type[Checked]) -> dict[str, Any]:
    """The schema of any one of several types."""
    return {"oneOf": [to(fields.def_name(cls)) for cls in classes]}


def to(name: str) -> dict[str, Any]:
    """A reference to a definition."""
    return {"$ref": f"#/$defs/{name}"}


def table_of_scene() -> dict[str, Any]:
    """The schema of a scene, as `scene.Scene.to_table` writes it, with its id and case."""
    positive = {"type": "number", "exclusiveMinimum": 0}
    known = {
        "id": KEBAB,
        "case": KEBAB,
        "title": fields.TEXT,
        "tests": fields.TEXT,
        "tags": {"type": "array", "items": {"enum": list(scene.TAGS)}},
        "max_bounces": {"oneOf": [{"const": "all"}, {"type": "integer", "minimum": 0}]},
        "tolerance": positive,
        "tolerance_scale": {"oneOf": [{"enum": ["max", "element"]}, positive]},
        "light": {"type": "array", "items": to("light")},
        "surface": {"type": "array", "items": to("surface")},
        "film": to("film"),
    }
    return {"type": "object", "properties": known, "required": [name for name in known if name != "tests"],
            "additionalProperties": False, "description": "One case of a scene; scenes/README.md says what each field means."}


if __name__ == "__main__":
    print(json.dumps(whole(), indent=2))
