"""Scenes in the formats of other tools, to be opened and rendered by hand: one writer a file.

A film of irradiance is exported as what `renderers.views` lays out for it: a diffuse receiver, seen from just above.
"""

from __future__ import annotations

import importlib
import re
from dataclasses import dataclass
from pathlib import Path
from types import UnionType
from typing import Any

import numpy as np

from lightproof import suite
from lightproof.renderers import views
from lightproof.renderers.views import View
from lightproof.scene import PointsFilm, Scene


class CannotExport(ValueError):
    """What the tool, or any picture, cannot hold of a scene: says what."""


@dataclass(frozen=True)
class Tool:
    """`module` has write(scene, path), which writes the main file `path` and its companions, or raises CannotExport; `suffix` is
    that of the main file."""

    module: str
    suffix: str


TOOLS = {
    "mitsuba": Tool("lightproof.exporting.mitsuba", ".xml"),
    "blender": Tool("lightproof.exporting.blender", ".blend"),
    "luxcore": Tool("lightproof.exporting.luxcore", ".cfg"),
    "pbrt": Tool("lightproof.exporting.pbrt", ".pbrt"),
    "radiance": Tool("lightproof.exporting.radiance", ".rad"),
    "usd": Tool("lightproof.exporting.usd", ".usda"),
}


def write(scene: Scene, tool: str, path: Path) -> None:
    """Write a scene for a tool of TOOLS. Raises CannotExport, OSError, and Unavailable where the tool itself has to write."""
    importlib.import_module(TOOLS[tool].module).write(scene.tangible, path)


def view(scene: Scene) -> View:
    """The camera, with its receiver where the film is one of irradiance. Raises CannotExport where no picture is the film."""
    if isinstance(scene.film, PointsFilm):
        raise CannotExport("a film of points is no picture; choose a scene whose film is a plane or a camera")
    reason = views.unsupported(scene)
    if reason:
        raise CannotExport(reason)
    return views.views(scene)[0]


def companion(path: Path, name: str) -> Path:
    """A file that goes beside the main file `path`, named after all of it: exports for several tools may share a folder."""
    return path.with_name(f"{path.name.replace('.', '-')}-{name}")


def remarks(scene: Scene, path: Path, picture: str = "") -> list[str]:
    """For a comment in the main file `path`: what a picture holds, and the command that judges the `picture`, by default of the
    main file's name (of a scene that is not Lightproof's own it names the file)."""
    seen = view(scene)
    columns, rows = seen.resolution
    name = scene.name if _is_known(scene) else scene.name.replace(scene.id, f"{scene.id}.toml", 1)
    judge = f"lightproof grade {picture or f'{path.stem}.exr'} --scene {name}"
    lines = [
        f"Lightproof scene {scene.name}: {scene.title}. Metres, z up.",
        f"Picture: {columns} x {rows} pixels, box filter; each the mean radiance [W/(m2 sr)] over its square, row 0 on top.",
    ]
    if seen.receiver:
        lines += [
            f"Seen is a diffuse receiver of reflectance rho = {seen.receiver.reflectance:g} that lies in the film, from above:"
            " E = pi L / rho.",
            "Columns run along the film's u; the top row is its far side, where v ends.",
        ]
        judge += " --quantity radiance"
    return [*lines, f"Judge it with: {judge}"]


def _is_known(scene: Scene) -> bool:
    """Whether a scene without its degenerate parts is Lightproof's own, and not a changed copy of the same name."""
    home = suite.default()
    own = home.cases(scene.id).get(scene.case) if scene.id in home.ids else None
    return own is not None and own.tangible == scene


def numbers(values: Any) -> str:
    """Numbers of an array in row-major order, as text that reads back to the same binary64."""
    return " ".join(repr(float(value)) for value in np.ravel(values))


def refuse(scene: Scene, kinds: type | UnionType, tool: str) -> None:
    """Raise CannotExport for the first light of the scene that is none of the `kinds` a writer knows how to say."""
    for light in scene.lights:
        if not isinstance(light, kinds):
            kind = re.sub("(?<=.)(?=[A-Z])", " ", type(light).__name__).lower()
            raise CannotExport(f"light '{light.id}': the export for {tool} has no {kind} yet")
