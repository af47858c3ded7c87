"""Another version of a renderer that Lightproof knows: one of its methods, under the Python interpreter that holds it."""

from __future__ import annotations

import os
import shutil
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from lightproof import checked
from lightproof.checked import Checked, SceneError
from lightproof.renderers import fields
from lightproof.renderers.registry import METHODS, Entry, unknown


def _method() -> Any:
    def check(value: Any) -> str:
        if not isinstance(value, str) or value not in METHODS:
            raise SceneError("", unknown(str(value)))
        return value

    return checked.rule(check, {"enum": list(METHODS)})


@dataclass(frozen=True)
class Version(Checked):
    """`method` under `python`, an interpreter on the PATH, or a path, which counts from the manifest's folder; `name` stands in
    the place of the renderer's: cycles/mesh becomes blender-5-2/mesh."""

    name: str = checked.identifier()
    method: str = _method()
    python: str = fields.text()

    def entry(self, path: Path) -> Entry:
        """The method that the manifest at `path` describes. Raises SceneError where there is no such interpreter."""
        python = shutil.which(str(path.parent / self.python) if os.sep in self.python else self.python)
        if python is None:
            raise SceneError(f"{path}: python", f"there is no executable {checked.shown(self.python)}; give the path of a Python"
                                                " interpreter with the renderer, numpy and OpenEXR")
        _, slash, option = self.method.partition("/")
        return replace(METHODS[self.method], name=f"{self.name}{slash}{option}", worker=str(path), nightly=False, python=python)
