"""A renderer's units, measured: the power that the walls of a black box collect from a light, over what the light emits.

The factor is 1 where the renderer's radiance or intensity means what the scene's does. Factors are kept and shown, and a step
from one version to the next is an alarm; no film is ever divided by one.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import get_type_hints

import numpy as np
import pandas as pd
from scipy import stats

from lightproof.reporting.evaluation import Cell, Evaluation
from lightproof.scene import AreaLight, Scene
from lightproof.statistics import ROUNDING
from lightproof.store import StoreError

SCENE, WALLS = "flux-closure", 6
CLOSED = 1e-9  # of a wall's area
LEVEL = 0.001  # how often a factor's interval may miss it
FILE = Path("reports/calibration.csv")


class UnitsError(StoreError):
    """A file of factors that cannot be read: says which and what would be right."""


@dataclass(frozen=True)
class Factor:
    """Measured over true power of one kind of `light` (point, polygon, disk, sphere), with the ends of its interval, as a
    `version` of a method renders it; from the run of that id, which `started` then."""

    method: str
    version: str
    light: str
    factor: float
    low: float
    high: float
    run: str
    started: str

    @property
    def of(self) -> tuple[str, str]:
        """What the factor is of, whatever the version."""
        return self.method, self.light


@dataclass(frozen=True)
class Alarm:
    """A factor that has left the interval of the version before."""

    now: Factor
    before: Factor

    @property
    def message(self) -> str:
        """In words."""
        ratio, now, before = self.now.factor / self.before.factor, self.now, self.before
        return (f"a {now.light} light is {ratio:.4g} times as bright in {now.version} as in {before.version}: {shown(now)} of its"
                f" power against {shown(before)}")


def shown(factor: Factor) -> str:
    """A factor with its interval."""
    return f"{factor.factor:.5f} ± {(factor.high - factor.low) / 2:.1g}"


def measure(evaluation: Evaluation) -> list[Factor]:
    """The factors that a run of every wall of the boxes tells."""
    walls: dict[tuple[str, str], list[Cell]] = {}
    for cell in evaluation.cells:
        if cell.scene.id == SCENE and cell.final and cell.reference:
            walls.setdefault((cell.method, light_of(cell.scene)), []).append(cell)
    return [_factor(evaluation, *box, cells) for box, cells in walls.items() if _closed(cells)]


def light_of(scene: Scene) -> str:
    """The kind of a scene's only light."""
    (light,) = scene.lights
    return type(light.shape).__name__.lower() if isinstance(light, AreaLight) else "point"


def _closed(cells: Sequence[Cell]) -> bool:
    """Whether the films are those of every wall: the area vectors of a closed surface add up to nothing."""
    areas = np.array([np.cross(cell.scene.film.u, cell.scene.film.v) for cell in cells])
    return len(cells) == WALLS and bool(np.abs(areas.sum(axis=0)).max() < CLOSED * np.abs(areas).max())


def _factor(evaluation: Evaluation, method: str, light: str, cells: Sequence[Cell]) -> Factor:
    """The sum over the walls, whose films are independent, with a t interval."""
    areas = [float(np.linalg.norm(np.cross(cell.scene.film.u, cell.scene.film.v))) for cell in cells]
    powers = [area * np.array([result.film.mean() for result in cell.final]) for area, cell in zip(areas, cells, strict=True)]
    true = sum(area * cell.reference.value.mean() for area, cell in zip(areas, cells, strict=True))
    factor, replicates = sum(power.mean() for power in powers) / true, min(map(len, powers))
    half = 0.0
    if replicates > 1:
        error = np.sqrt(sum(power.var(ddof=1) / len(power) for power in powers)) / true
        half = float(stats.t.ppf(1 - LEVEL / 2, replicates - 1) * error)
    run, version = evaluation.run, cells[0].results[-1].version
    return Factor(method, version, light, float(factor), float(factor - half), float(factor + half), run.id, run.started)


def read(path: Path) -> list[Factor]:
    """The factors that are kept, in the order in which they were measured; none where there is no file. Raises UnitsError."""
    columns = get_type_hints(Factor)
    if not path.exists():
        return []
    try:
        table = pd.read_csv(path, dtype=columns, keep_default_na=False, float_precision="round_trip")[list(columns)]
    except (OSError, ValueError, KeyError) as error:
        raise UnitsError(f"{path}: is no file of factors ({error}); restore it, or move it away and calibrate again") from None
    return [Factor(*row) for row in table.itertuples(index=False)]


def keep(path: Path, factors: Iterable[Factor]) -> None:
    """Add factors to those that are kept, none of which is replaced. Raises UnitsError, OSError."""
    known = read(path)
    table = pd.DataFrame([asdict(factor) for factor in dict.fromkeys([*known, *factors])], columns=list(get_type_hints(Factor)))
    partial = path.with_suffix(".partial")
    partial.parent.mkdir(parents=True, exist_ok=True)
    table.to_csv(partial, index=False)
    partial.rename(path)


def current(factors: Iterable[Factor], versions: dict[str, str]) -> list[Factor]:
    """The last factor of each kind of light and method in the version that `versions` names."""
    last = {factor.of: factor for factor in factors if versions.get(factor.method) == factor.version}
    return list(last.values())


def alarms(factors: Sequence[Factor], now: Iterable[Factor]) -> list[Alarm]:
    """Where the interval of a factor and that of the last other version measured before it lie apart, by more than rounding."""
    found = []
    for factor in now:
        others = [other for other in factors if other.of == factor.of and other.version != factor.version
                  and other.started < factor.started]
        if others and max(factor.low - others[-1].high, others[-1].low - factor.high) > ROUNDING * others[-1].factor:
            found.append(Alarm(factor, others[-1]))
    return found
