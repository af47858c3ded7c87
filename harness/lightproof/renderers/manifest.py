"""What a renderer outside says of itself in a small TOML file: its command, and what it supports."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

from lightproof import checked, geometry, scene, scene_file
from lightproof.checked import Checked, SceneError
from lightproof.method import Unavailable
from lightproof.renderers import fields
from lightproof.renderers.registry import Entry
from lightproof.renderers.versions import Version
from lightproof.scene import Scene

QUANTITIES = ("irradiance", "radiance", "solid_angle")
LIGHTS = {
    "area": scene.AreaLight,
    "point": scene.PointLight,
    "directional": scene.DirectionalLight,
    "environment": scene.Environment,
    "sun-disc": scene.SunDisc,
    "overcast-sky": scene.OvercastSky,
}
GLOWING = "glowing-surface"  # a surface with a radiance of its own
ALL = "all"


def _reflections() -> Any:
    schema = {"oneOf": [{"const": ALL}, {"type": "integer", "minimum": 0}]}
    return checked.rule(lambda value: value if value == ALL else checked.to_count(value), schema, ALL)


def _command() -> Any:
    def check(value: Any) -> tuple[str, ...]:
        words = fields.several(value, checked.to_text, 1)
        program = PurePosixPath(words[0])
        if program.is_absolute() or ".." in program.parts:
            raise SceneError("[0]", f"{checked.shown(words[0])} is not accepted; give the name of a program on the PATH, or the"
                                    " path of one beside the manifest, such as './my-renderer'")
        return words

    return checked.rule(check, {"type": "array", "items": fields.TEXT, "minItems": 1})


@dataclass(frozen=True)
class Supports(Checked):
    """What a renderer can do; a scene that needs anything else is not sent to it. What is left out is supported."""

    quantities: tuple[str, ...] = fields.choices(*QUANTITIES)
    films: tuple[str, ...] = fields.choices(*scene_file.FILMS)
    lights: tuple[str, ...] = fields.choices(*LIGHTS, GLOWING)
    shapes: tuple[str, ...] = fields.choices(*geometry.SHAPES)
    reflections: int | str = _reflections()

    def lacks(self, asked: Scene) -> str | None:
        """What a scene needs and is not here, or None."""
        for name, needed in _needs(asked).items():
            missing = sorted(needed - set(getattr(self, name)))
            if missing:
                return f"the {name} that its manifest supports are {', '.join(getattr(self, name))}; this scene has {missing[0]}"
        bounces = asked.max_bounces if asked.reflects else 0
        if self.reflections != ALL and (bounces == ALL or bounces > self.reflections):
            return f"its manifest supports at most {self.reflections} reflections, and this scene has {bounces}"
        return None


@dataclass(frozen=True)
class Manifest(Checked):
    """A renderer: its `command` and the one that prints its `version`, as lists of words; whether it is started once for each job
    or stays up (`lasting`); and what the harness has to know of its films, as `method.Method` has it."""

    name: str = checked.identifier()
    command: tuple[str, ...] = _command()
    version: tuple[str, ...] = _command()
    mode: str = checked.choice("once", "lasting", default="once")
    deterministic: bool = fields.flag(False)
    samples_lights: bool = fields.flag(False)
    precision: str = checked.choice("float16", "float32", "float64", default="float32")
    supports: Supports = fields.nested(Supports, default=Supports())

    def entry(self, path: Path) -> Entry:
        """The method that the manifest at `path` describes."""
        return Entry(self.name, f"{path}:Outside", worker=str(path))


def read(path: Path) -> Manifest | Version:
    """The manifest in a file: of a renderer, or, where it names a `method`, of another version of one that Lightproof knows.
    Raises SceneError, which names the file, the field and what would be right."""
    try:
        table = scene_file.read_table(path, "manifest")
        return (Version if "method" in table else Manifest).from_table(table)
    except SceneError as error:
        raise SceneError(str(path), str(error)) from None


def found(command: Sequence[str], folder: Path) -> list[str]:
    """A command with the path of its program, which is on the PATH, or in `folder` where it is given with a slash. Raises
    Unavailable."""
    beside = "/" in command[0]
    program = shutil.which(folder / command[0] if beside else command[0])
    if program is None:
        where = f"in {folder}: build it there" if beside else "on the PATH: install it"
        raise Unavailable(f"there is no executable {command[0]} {where}")
    return [program, *command[1:]]


def _needs(asked: Scene) -> dict[str, set[str]]:
    things = [*asked.lights, *asked.surfaces]
    lights = {name for light in asked.lights for name, kind in LIGHTS.items() if type(light) is kind}
    glowing = {GLOWING} if any(surface.radiance for surface in asked.surfaces) else set()
    return {
        "quantities": {asked.film.quantity},
        "films": {asked.film.TAG[1]},
        "lights": lights | glowing,
        "shapes": {thing.shape.TAG[1] for thing in things if hasattr(thing, "shape")},
    }
