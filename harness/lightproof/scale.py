"""What makes films of a scene comparable: the scale of its errors, and the tiles in which they are pooled."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lightproof import statistics
from lightproof.references import Reference
from lightproof.scene import Scene


@dataclass(frozen=True)
class Scale:
    """The exact light of a scene (n,), its uncertainty (n,) and the scale `unit` of its tolerance (n,), in its film's unit."""

    grid: tuple[int, int]
    value: np.ndarray
    uncertainty: np.ndarray
    unit: np.ndarray

    @classmethod
    def of(cls, scene: Scene, reference: Reference) -> Scale:
        """The scale of a scene's errors. Where each element has its own ("element"), one whose light is zero takes the film's
        largest, as "max" would. Raises ValueError where every reference value is zero and the scene gives no number."""
        largest = np.abs(reference.value).max()
        match scene.tolerance_scale:
            case "max":
                unit = np.full(scene.size, largest)
            case "element":
                unit = np.where(reference.value == 0, largest, np.abs(reference.value))
            case number:
                unit = np.full(scene.size, number)
        if not unit.all():
            wanted = "give tolerance_scale a number in the film's unit"
            raise ValueError(f"the exact light of {scene.name} is zero everywhere; {wanted}")
        return cls(scene.film.grid, reference.value, reference.uncertainty, unit)

    def pooled(self, elements: np.ndarray) -> np.ndarray:
        """Elements (..., n) -> tiles, mean, elements (..., J + 1 + n)."""
        tiles = statistics.tile_means(elements, self.grid)
        return np.concatenate([tiles, elements.mean(axis=-1, keepdims=True), elements], axis=-1)

    @cached_property
    def tiles(self) -> int:
        """Number of tiles J, at most TILES; also the index of the film's mean among the intervals."""
        return int(np.prod([len(starts) for starts in statistics.tile_starts(self.grid)]))

    def place(self, index: int) -> str:
        """What an interval is about, in words."""
        points = self.grid[0] == 1
        if index == self.tiles:
            return "the film's mean"
        if index > self.tiles:
            row, column = divmod(index - self.tiles - 1, self.grid[1])
            return f"point {column}" if points else f"the element at row {row}, column {column}"
        if points and self.tiles == self.grid[1]:
            return f"point {index}"
        rows, columns = statistics.tile_starts(self.grid)
        top, left = divmod(index, len(columns))
        bottom, right = (*rows[1:], self.grid[0])[top] - 1, (*columns[1:], self.grid[1])[left] - 1
        across = f"{columns[left]}-{right}"
        return f"the tile of points {across}" if points else f"the tile of rows {rows[top]}-{bottom}, columns {across}"

    @cached_property
    def lit(self) -> np.ndarray:
        """Where light is due, (J + 1 + n,)."""
        return self.pooled(self.value) > 0
