"""How much one sample of a method scatters along a sweep: whose variance explodes where, and whose does not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lightproof.reporting.configurations import together
from lightproof.reporting.hard import Group, Row, Square
from lightproof.reporting.hard_deviation import Deviation
from lightproof.reporting.hard_findings import BROKEN, missing, where

MOST = 10  # times the exact light: what the standard deviation of one sample may be
FLAT, EXPLODES = f"never above {MOST} times the exact light", f"explodes: above {MOST} times the exact light"


@dataclass(frozen=True)
class Spread:
    """One sampling method on one hard case, by points (n,)."""

    one: Deviation

    @cached_property
    def samples(self) -> int:
        """Of all films together, at one point."""
        return sum(result.samples for result in self.one.cell.final)

    @cached_property
    def hidden(self) -> np.ndarray:
        """Where the mean is off by more than films scatter, so that their scatter tells too little."""
        return np.abs(self.one.error) > np.maximum(self.one.scatter, BROKEN)

    @cached_property
    def relative(self) -> np.ndarray:
        """The standard deviation of one sample over the exact light, from that of the mean; NaN where no light is due.

        Where `hidden`, what it is at least if the method is right in the mean: a share d of the light that N samples did not
        meet comes by samples rarer than 1/N, which add more than d^2 N to the variance (Cauchy and Schwarz)."""
        share = np.where(self.hidden, np.abs(self.one.error), self.one.standard_error)
        return np.where(self.one.cell.reference.value > 0, share * np.sqrt(self.samples), np.nan)

    @cached_property
    def explodes(self) -> np.ndarray:
        """Where one sample scatters much: as measured, or as the method knows of samples that weigh as much as is missing."""
        known = np.isfinite(self.one.leap) & (self.one.systematic == 0)
        return (self.relative > MOST) & (~self.hidden | known)

    @cached_property
    def untold(self) -> np.ndarray:
        """Where the mean is off, by samples too rare to be met or for good: from outside nobody can tell."""
        return self.hidden & ~self.explodes & ~np.isnan(self.relative)


def of(square: Square) -> Spread | None:
    """None for a method without noise, and where not enough is known of it."""
    one = square.deviation
    spread = Spread(one) if one and not one.certain else None
    return spread if spread and spread.samples else None


def sentences(group: Group) -> dict[str, list[str]]:
    """Sentence -> the sampling methods of which it is true: that scatter little, that do not, and of which nobody can tell; empty
    where nothing is swept."""
    said: dict[str, dict[str, str]] = {}
    for squares in zip(*(row.squares for row in group.rows), strict=True) if group.swept else ():
        spreads = [(row, spread) for row, square in zip(group.rows, squares, strict=True) if (spread := of(square))]
        for sentence in _sentences(group, spreads, bool(missing(group.rows, squares))):
            said.setdefault(sentence, {})[squares[0].method] = ""
    order = sorted(said, key=lambda sentence: (not sentence.startswith(FLAT), not sentence.startswith(EXPLODES)))
    return {sentence: together(said[sentence], group.methods) for sentence in order}


def _sentences(group: Group, spreads: list[tuple[Row, Spread]], partly: bool) -> list[str]:
    def at(marked: Callable[[Spread], np.ndarray]) -> str:
        return where(group, [(row, marked(spread)) for row, spread in spreads])

    if not spreads:
        return []
    exploding, untold = at(lambda spread: spread.explodes), at(lambda spread: spread.untold)
    said = {
        f"{EXPLODES} {exploding}": exploding,
        f"not to be told {untold}: off by more than films scatter, by light too rare to be met or missing for good": untold,
        f"{FLAT}{' where it was measured' if partly else ''}": not exploding and not untold,
    }
    return [sentence for sentence, true in said.items() if true]
