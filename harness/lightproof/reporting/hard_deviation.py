"""How far one method is from the proven light at each point of a hard case, noise set apart from what is systematic."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lightproof import statistics
from lightproof.reporting.evaluation import Cell
from lightproof.reporting.sweeps import place
from lightproof.reporting.wording import number, signed

ROUNDING = 1e-5  # a smaller systematic error may be that of float32
LEVEL = 1e-4  # chance that noise alone makes any point of a cell look systematically off
ALIKE = 1e-12  # of a value: the standard error of films that do not differ
FORMATS = {"float64": np.float64, "float32": np.float32, "float16": np.float16}


@dataclass(frozen=True)
class Deviation:
    """One method on one hard case, by points (n,): all but `ulps` are fractions of the exact light, or of the tolerance scale
    where that is zero. `noise` is what chance may have done: the half-width of an interval from the scatter between films,
    and the most that a sample which no film met could add."""

    cell: Cell

    @cached_property
    def unit(self) -> np.ndarray:
        """What errors are fractions of, in the film's unit."""
        exact = np.abs(self.cell.reference.value)
        return np.where(exact > 0, exact, self.cell.scale)

    @cached_property
    def error(self) -> np.ndarray:
        """Of the mean over replicates."""
        return (self.cell.film - self.cell.reference.value) / self.unit

    @property
    def certain(self) -> bool:
        """Whether the method has no noise, or shows none for want of films."""
        return self.cell.final[0].deterministic or self.alone

    @property
    def alone(self) -> bool:
        """Whether there is a single film where others would differ."""
        return not self.cell.final[0].deterministic and len(self.cell.final) == 1

    @cached_property
    def standard_error(self) -> np.ndarray:
        return np.zeros_like(self.error) if self.cell.standard_error is None else self.cell.standard_error / self.unit

    @cached_property
    def unlit(self) -> np.ndarray:
        """Where light is due and a method that does not aim at lights has met none."""
        aims = self.certain or self.cell.final[0].samples_lights
        return (self.cell.film == 0) & (self.cell.reference.value > 0) & (not aims)

    @cached_property
    def leap(self) -> np.ndarray:
        """What a single sample that no film met could add to the mean at most: without bound where unlit, 0 where the method
        does not know."""
        if self.certain:
            return np.zeros_like(self.error)
        known = np.zeros_like(self.unit) if self.peak is None else self.peak / sum(result.samples for result in self.cell.final)
        return np.where(self.unlit, np.inf, known / self.unit)

    @cached_property
    def peak(self) -> np.ndarray | None:
        """The largest value that one sample can have, in the film's unit; None where the method does not know it."""
        peaks = [result.peak for result in self.cell.final if result.peak is not None]
        return np.max(peaks, axis=0) if peaks else None

    @cached_property
    def scatter(self) -> np.ndarray:
        """The half-width of an interval from the scatter between films, which holds at all points but for a chance of `LEVEL`.
        Where all films are alike and no `peak` tells what another sample could do, of N samples none was black, so that black
        ones are at most -ln(LEVEL) in N (Hanley and Lippman-Hand 1983): that share of the value is in doubt."""
        if self.certain:
            return np.zeros_like(self.error)
        samples, value = sum(result.samples for result in self.cell.final), np.abs(self.cell.film) / self.unit
        quantile = statistics.simultaneous_quantile(LEVEL, len(self.error), len(self.cell.final))
        black = min(1.0, -np.log(LEVEL) / samples) if samples else 1.0
        alike = (self.standard_error <= ALIKE * value) & (self.peak is None)
        return np.where(alike, black * value, quantile * self.standard_error)

    @cached_property
    def noise(self) -> np.ndarray:
        return self.scatter + self.leap

    @cached_property
    def systematic(self) -> np.ndarray:
        """What of the error noise does not explain."""
        return np.maximum(np.abs(self.error) - self.noise, 0)

    @property
    def worst(self) -> int:
        """The point with the largest systematic error, or else with the most noise."""
        return int(np.argmax(self.systematic if self.off else self.noise))

    @cached_property
    def off(self) -> bool:
        """Whether there is a systematic error to speak of anywhere: of rounding only where noise is less."""
        largest = self.systematic.max()
        return self.certain or bool(largest > ROUNDING or largest > self.noise.max())

    @property
    def unbounded(self) -> bool:
        """Whether what most blurs the worst point is a single sample that no film met."""
        return not self.off and self.leap[self.worst] > self.noise[self.worst] / 2

    @property
    def level(self) -> float:
        """The cell's one number: the error where it is systematic, what noise leaves open where it is not."""
        return float(np.abs(self.error[self.worst]) if self.off else self.noise[self.worst])

    @cached_property
    def ulps(self) -> np.ndarray | None:
        """Error (n,) in units in the last place of the exact value in the method's precision, NaN where that is zero; None where
        its precision is not a floating-point format."""
        precision = FORMATS.get(self.cell.final[0].precision)
        if precision is None:
            return None
        exact = self.cell.reference.value
        with np.errstate(all="ignore"):
            spacing = np.spacing(np.abs(exact).astype(precision)).astype(float)
            return np.where(exact != 0, np.abs(self.cell.film - exact) / spacing, np.nan)

    @property
    def place(self) -> str:
        """The worst point in words."""
        return place(self.cell.scene, self.worst)

    @property
    def told(self) -> str:
        """All of it in a sentence or two."""
        at, last = self.worst, self.cell.final[0]
        error, deviation = signed(self.error[at]), number(self.standard_error[at], 2)
        if self.certain:
            return f"worst {self.place}: off by {error}{self._in_ulps(at)}; no noise"
        films = f"standard error of {len(self.cell.final)} films of {last.samples:,} samples"
        if self.unbounded:
            return (f"no systematic error can be told: at worst, {self.place}, a single sample could move the mean by"
                    f" {number(self.leap[at], 2)}; it is off by {error} ± {deviation} ({films})")
        if not self.off:
            return f"no systematic error seen: at worst, {self.place}, the mean is off by {error} ± {deviation} ({films})"
        return (f"worst {self.place}: the mean is off by {error} ± {deviation} ({films}),"
                f" of which noise does not explain {number(self.systematic[at], 2)}{self._in_ulps(at)}")

    def _in_ulps(self, at: int) -> str:
        known = self.ulps is not None and np.isfinite(self.ulps[at])
        return f", {number(self.ulps[at], 2)} units in the last place of {self.cell.final[0].precision}" if known else ""
