"""Paths in a sphere that are summed, and not walked, from the wall on: see `recursion`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from lightproof.estimators import recursion
from lightproof.estimators.options import Choices
from lightproof.estimators.path import Path
from lightproof.estimators.paths import Paths, paths
from lightproof.estimators.views import View
from lightproof.scene import CameraFilm, Scene


class PathRecursion(Path):
    """Light in a diffuse sphere of one or two zones, with any number of point lights; `path/recursion`."""

    choices: ClassVar[Choices] = {"lights": {"recursion": True}, **{kind: Path.choices[kind] for kind in ("points", "precision")}}

    def settings(self) -> Mapping[str, Any]:
        return {**super().settings(), "pdf": "1/(4 pi r^2) per area of the wall", "roulette": "none"}

    def untraceable(self, scene: Scene) -> str | None:
        return recursion.unsupported(scene)

    def seen(self, scene: Scene) -> View | None:
        return None

    def followed(self, scene: Scene) -> Paths:
        inside = not recursion.on_wall(scene) and not isinstance(scene.film, CameraFilm)
        return replace(paths(scene), recursion=recursion.recursion(scene), inside=inside)
