"""Admit references: both engines, their agreement, the acceptance criteria, and the files.

The criteria are explained in references/README.md.
"""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from io import StringIO
from pathlib import Path

import numpy as np

from lightproof import geometry
from lightproof.certify import engine, provenance, register, sampling, second_engine
from lightproof.certify.balls import CannotCertify
from lightproof.certify.engine import Certified, certify
from lightproof.scene import PointsFilm, Scene, Surface

# Largest uncertainty, relative to the film's largest value: at points and of means, open, behind polygons and behind curves.
AT_POINTS, AT_POINTS_BEHIND_CURVES = 1e-15, 1e-12
OF_MEANS, IN_SHADOWS, IN_ROUND_SHADOWS = 1e-12, 1e-9, 1e-6
BELOW_TOLERANCE = 1000  # times the uncertainty must fit into the scene's tolerance


@dataclass(frozen=True)
class Admitted:
    """One case of a reference: values and uncertainties, and how well the second engine agrees, relative to `scale`, on
    `checked` of the elements."""

    scene: Scene
    certified: Certified
    second_engine: str
    agreement: float
    checked: int

    @property
    def scale(self) -> float:
        """The film's largest value, or 1 where all is dark."""
        return _scale(self.certified.value)

    @property
    def uncertainty(self) -> np.ndarray:
        """(n,) What both engines vouch for: the proven bound, and no less than the largest difference between them."""
        floor = 0.0 if math.isnan(self.agreement) else self.agreement * self.scale
        return np.maximum(self.certified.uncertainty, floor)


def admit(scene: Scene, folder: Path, progress: Callable[[], None] = lambda: None) -> Admitted:
    """The reference of one scene, from both engines; `folder` is the suite's references/.

    Without a second script the first engine stands alone. Raises CannotCertify, with the scene's name, where no engine covers
    the scene, or where an acceptance criterion fails. `progress` is called after each element of the first engine.
    """
    try:
        return _admit(scene, folder, progress)
    except CannotCertify as reason:
        raise CannotCertify(f"{scene.name}: {reason}") from None


def _admit(scene: Scene, folder: Path, progress: Callable[[], None]) -> Admitted:
    certified = certify(scene, progress=progress)
    script = second_engine.find(scene.id, folder)
    if script:
        elements = sampling.chosen(scene, certified.value, bool(_blockers(scene)))
        difference = float(np.abs(second_engine.values(script, scene, elements) - certified.value[elements]).max())
        admitted = Admitted(scene, certified, script.name, difference / _scale(certified.value), len(elements))
    else:
        admitted = Admitted(scene, certified, "none", math.nan, 0)
    _accept(admitted)
    return admitted


def limit(scene: Scene, value: np.ndarray) -> np.ndarray:
    """(n,) The largest uncertainty [the film's unit] with which each element of a film `value` (n,) is admitted."""
    largest = np.full_like(value, _scale(value))
    scales = {"max": largest, "element": np.abs(value)}
    scale = scales.get(scene.tolerance_scale, scene.tolerance_scale)
    return np.minimum(_class(scene) * largest, scene.tolerance * scale / BELOW_TOLERANCE)


def _class(scene: Scene) -> float:
    blockers = _blockers(scene)
    curved = any(not isinstance(surface.shape, geometry.Polygon) for surface in blockers)
    if isinstance(scene.film, PointsFilm):
        return AT_POINTS_BEHIND_CURVES if curved else AT_POINTS
    if curved:
        return IN_ROUND_SHADOWS
    return IN_SHADOWS if blockers else OF_MEANS


def _blockers(scene: Scene) -> list[Surface]:
    """What only blocks."""
    return [surface for surface in scene.surfaces if surface.reflectance == surface.radiance == 0]


def _scale(value: np.ndarray) -> float:
    """The largest value of a film, or 1 where all is dark."""
    return float(np.abs(value).max()) or 1.0


def _accept(admitted: Admitted) -> None:
    """Raises CannotCertify where the first engine's bound, or the difference between the engines, exceeds the limit."""
    value, excess = admitted.certified.value, admitted.uncertainty
    over = np.flatnonzero(~(excess <= limit(admitted.scene, value)))
    if over.size:
        raise CannotCertify(f"the uncertainty of element {over[0]}, {excess[over[0]]:.2g}, exceeds"
                            f" {limit(admitted.scene, value)[over[0]]:.2g} (first engine"
                            f" {admitted.certified.uncertainty[over[0]]:.2g}, {admitted.second_engine} differs by"
                            f" {admitted.agreement * admitted.scale:.2g} at most)")


def write(folder: Path, cases: Mapping[str, Admitted]) -> None:
    """Write <id>.csv and <id>.toml for every case of one scene, and the register in the folder's README.md."""
    scene = next(iter(cases.values())).scene
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{scene.id}.csv").write_text(_csv(cases), encoding="utf-8")
    (folder / f"{scene.id}.toml").write_text(_toml(cases), encoding="utf-8")
    register.refresh(folder)


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
    scenes = [admitted.scene for admitted in cases.values()]
    about = provenance.joined(engine.solver(scene).provenance_of(scene) for scene in scenes)
    lines = [f"formula = {_text(about.formula)}", f"source = {_text(about.source)}", f"citations = {json.dumps(about.citations)}"]
    for case, admitted in cases.items():
        lines += [
            "",
            f"[cases.{case}]",
            f'scene_digest = "{admitted.scene.digest}"',
            f'engine = "{admitted.certified.engine}"',
            f'second_engine = "{admitted.second_engine}"',
            f'kind = "{admitted.certified.kind}"',
            f"agreement = {admitted.agreement!r}",
            f"uncertainty = {_up(float(admitted.uncertainty.max()) / admitted.scale)}",
            f"elements_checked = {admitted.checked}",
        ]
    return "\n".join(lines) + "\n"


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
