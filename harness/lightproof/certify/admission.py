"""Admit references: both engines, their agreement, the acceptance criteria, and the files.

A suite's second engine is the script references/<id>.py, which shares no code with the first: its function
`values(table, elements)` takes a scene as `Scene.to_table` gives it. The criteria are explained in references/README.md.
"""

from __future__ import annotations

import csv
import json
import math
import runpy
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from io import StringIO
from pathlib import Path

import numpy as np

from lightproof.certify import provenance
from lightproof.certify.balls import CannotCertify
from lightproof.certify.engine import Certified, certify
from lightproof.scene import PointsFilm, Scene

AT_POINTS, OF_MEANS, IN_SHADOWS = 1e-15, 1e-12, 1e-9  # largest uncertainty, relative to the film's largest value
BELOW_TOLERANCE = 1000  # times the uncertainty must fit into the scene's tolerance
KIND = "enclosure"


@dataclass(frozen=True)
class Admitted:
    """One case of a reference: values and uncertainties, and how well the second engine agrees, relative to `scale`."""

    scene: Scene
    certified: Certified
    second_engine: str
    agreement: float

    @property
    def scale(self) -> float:
        """The film's largest value, or 1 where all is dark."""
        return float(np.abs(self.certified.value).max()) or 1.0

    @property
    def uncertainty(self) -> np.ndarray:
        """(n,) What both engines vouch for: the proven bound, and no less than the largest difference between them."""
        floor = 0.0 if math.isnan(self.agreement) else self.agreement * self.scale
        return np.maximum(self.certified.uncertainty, floor)


def admit(scene: Scene, folder: Path, progress: Callable[[], None] = lambda: None) -> Admitted:
    """The reference of one scene, from both engines; `folder` is the suite's references/, `progress` is called after each element.

    Without a second script the first engine stands alone, its values being proven enclosures. Raises CannotCertify where no
    engine covers the scene, or where an acceptance criterion fails.
    """
    certified = certify(scene, progress=progress)
    scale = float(np.abs(certified.value).max()) or 1.0
    script = folder / f"{scene.id}.py"
    if script.is_file():
        difference = float(np.abs(second(script, scene, range(scene.size)) - certified.value).max())
        admitted = Admitted(scene, certified, script.name, difference / scale)
    else:
        admitted = Admitted(scene, certified, "none", math.nan)
    _accept(admitted)
    return admitted


def second(script: Path, scene: Scene, elements: Iterable[int]) -> np.ndarray:
    """Values of film elements by the second engine."""
    return np.array(runpy.run_path(str(script))["values"](scene.to_table(), list(elements)))


def limit(scene: Scene) -> float:
    """The largest uncertainty with which a reference is admitted, relative to the film's largest value."""
    shadows = scene.surfaces and scene.film.quantity == "irradiance" and scene.max_bounces == 0
    means = IN_SHADOWS if shadows else OF_MEANS
    scale = scene.tolerance_scale if isinstance(scene.tolerance_scale, float) else 1.0
    return min(AT_POINTS if isinstance(scene.film, PointsFilm) else means, scene.tolerance * scale / BELOW_TOLERANCE)


def _accept(admitted: Admitted) -> None:
    """Raises CannotCertify where the engines' bounds, or the difference between them, exceed the limit."""
    scene, worst = admitted.scene, float(admitted.uncertainty.max()) / admitted.scale
    if not worst <= limit(scene):
        raise CannotCertify(f"{scene.name}: the uncertainty, {worst:.2g} of the film's largest value, exceeds {limit(scene):.2g}"
                            f" (first engine {admitted.certified.uncertainty.max() / admitted.scale:.2g},"
                            f" difference from {admitted.second_engine} {admitted.agreement:.2g})")


def write(folder: Path, cases: Mapping[str, Admitted]) -> None:
    """Write <id>.csv and <id>.toml for every case of one scene."""
    scene = next(iter(cases.values())).scene
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{scene.id}.csv").write_text(_csv(cases), encoding="utf-8")
    (folder / f"{scene.id}.toml").write_text(_toml(cases), encoding="utf-8")


def _csv(cases: Mapping[str, Admitted]) -> str:
    """Values to 17 significant digits: the binary64 that they stand for. Uncertainties rounded up."""
    text = StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(("case", "element", "value", "uncertainty"))
    for case, admitted in cases.items():
        for element, (value, uncertainty) in enumerate(zip(admitted.certified.value, admitted.uncertainty, strict=True)):
            rows.writerow((case, element, f"{value:.17g}", _up(uncertainty)))
    return text.getvalue()


def _up(number: float) -> str:
    """Two significant digits, rounded up."""
    text = f"{number:.1e}"
    return text if float(text) >= number else f"{number * 1.05:.1e}"


def _toml(cases: Mapping[str, Admitted]) -> str:
    about = provenance.of(next(iter(cases.values())).scene)
    lines = [f"formula = {_text(about.formula)}", f"source = {_text(about.source)}", f"citations = {json.dumps(about.citations)}"]
    for case, admitted in cases.items():
        lines += [
            "",
            f"[cases.{case}]",
            f'scene_digest = "{admitted.scene.digest}"',
            f'engine = "{admitted.certified.engine}"',
            f'second_engine = "{admitted.second_engine}"',
            f'kind = "{KIND}"',
            f"agreement = {admitted.agreement!r}",
            f"uncertainty = {_up(float(admitted.uncertainty.max()) / admitted.scale)}",
            f"elements_checked = {0 if admitted.second_engine == 'none' else admitted.scene.size}",
        ]
    return "\n".join(lines) + "\n"


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
