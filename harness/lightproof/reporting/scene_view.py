"""What the page shows of one scene, ready for its template."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lightproof.radiometry import QUANTITIES, Quantity
from lightproof.references import Reference
from lightproof.reporting import wording
from lightproof.reporting.choice import Choice, choices
from lightproof.reporting.citations import Citation
from lightproof.reporting.colours import LIGHT, SIGNED, ColourMap, film_image
from lightproof.reporting.evaluation import Cell
from lightproof.scene import PointsFilm, Scene

ROUND = (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10)
STANDARD_ERRORS = 4.0
TOLERANCES = 2.0


@dataclass(frozen=True)
class Bar:
    """A colour bar: its ends are what the images of one column share."""

    title: str
    unit: str
    low: float
    high: float
    colours: ColourMap

    @property
    def ticks(self) -> list[str]:
        """Labels at the ends and at the quarters."""
        return [wording.number(value) for value in np.linspace(self.low, self.high, 5)]

    def image(self, values: np.ndarray, scene: Scene) -> str:
        """A film drawn on this bar's scale, as a data URI."""
        return film_image(values, scene.film, self.colours, self.low, self.high)


@dataclass(frozen=True)
class SceneView:
    """One scene: its reference, and every method's cell. `picture` is a data URI, or `missing` says why there is none."""

    scene: Scene
    cells: Sequence[Cell]
    methods: Sequence[str]
    picture: str
    missing: str
    bibliography: Mapping[str, Citation]

    @property
    def anchor(self) -> str:
        """The scene's id on the page."""
        return f"{self.scene.id}--{self.scene.case}"

    @cached_property
    def reference(self) -> Reference | None:
        """The exact light, None where no method could be judged for want of it."""
        return next((cell.reference for cell in self.cells if cell.reference is not None), None)

    @property
    def citations(self) -> list[Citation]:
        """The reference's sources; a key that the bibliography lacks stands for itself."""
        return [self.bibliography.get(key, Citation(key)) for key in self.reference.citations]

    @property
    def quantity(self) -> Quantity:
        """What the film holds."""
        return QUANTITIES[self.scene.film.quantity]

    @property
    def points(self) -> bool:
        """Whether the film is a list of points: a table then says more than an image."""
        return isinstance(self.scene.film, PointsFilm)

    @property
    def measured(self) -> list[Cell]:
        """The cells that have films judged by the reference."""
        return [cell for cell in self.cells if cell.step]

    @property
    def unmeasured(self) -> list[Cell]:
        """The others, each with a reason."""
        return [cell for cell in self.cells if cell not in self.measured]

    @cached_property
    def bars(self) -> tuple[Bar, Bar, Bar]:
        """The common scales of this scene: light, error and error in standard errors."""
        error = 100 * TOLERANCES * self.scene.tolerance
        return (
            Bar(self.quantity.name, self.quantity.unit, 0.0, round_up(float(self.reference.value.max())), LIGHT),
            Bar("error", f"% of {self.scale}", -error, error, SIGNED),
            Bar("error", "standard errors", -STANDARD_ERRORS, STANDARD_ERRORS, SIGNED),
        )

    @property
    def scale(self) -> str:
        """What errors are fractions of, in words."""
        words = {"max": "the largest value", "element": "each value"}
        return words.get(self.scene.tolerance_scale, f"{self.scene.tolerance_scale} {self.quantity.unit}")

    @property
    def exact(self) -> str:
        """The exact light as a data URI."""
        return self.bars[0].image(self.reference.value, self.scene)

    def images(self, cell: Cell) -> list[str]:
        """A method's film, its error and its error in standard errors (not for a single film) as data URIs."""
        light, error, deviation = self.bars
        drawn = [light.image(cell.film, self.scene), error.image(100 * cell.error, self.scene)]
        return drawn if cell.z_score is None else [*drawn, deviation.image(cell.z_score, self.scene)]

    @property
    def timed(self) -> bool:
        """Whether it is known of any method what its error costs."""
        return any(cell.drawable for cell in self.cells)

    @cached_property
    def choices(self) -> list[Choice]:
        """What to use, for each error."""
        return choices(self.cells)


def round_up(value: float) -> float:
    """The next round number, for the end of a scale; 1 for a film without light."""
    if value <= 0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in ROUND if step * power >= value * (1 - 1e-12))
