"""A ladder of samples as measured: what every step says about the bias, before any verdict.

Errors are fractions of the tolerance scale throughout. A step's intervals concern the tiles, then the film's mean, then
every element; each is mean - reference +- (q s / sqrt(R) + U).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lightproof import statistics
from lightproof.scale import Scale
from lightproof.scene import Scene
from lightproof.statistics import TILES
from lightproof.trial import Result, Status

FACTOR = 4
TILE_LEVEL = 0.004  # chance that any tile's or the mean's interval misses, at one step
ELEMENT_LEVEL = 0.001  # the same for all elements together
WIDEST_VOTE = 10  # tolerances: an interval that noise makes wider does not vote
SHRINKING = 0.7  # an error without noise that falls by less than this from step to step has stopped shrinking
SETTLED = 0.1  # of its error: a film without noise that a step moved by less is not on its way to the right answer
SAME_FILM = 1e-5  # of the scale: films without noise that agree so well at N and 4N are one answer
TRIPLES = 1600  # (scene, case, method) that a suite may hold before TILE_LEVEL has to shrink
POWER = 3  # standard errors beyond q at which a bias is seen nearly always


@dataclass(frozen=True)
class Rung:
    """One step of the ladder: `results` are its films, `errors` (R, n) theirs; `replicates` is what a whole step has."""

    samples: int
    results: tuple[Result, ...]
    replicates: int
    scale: Scale
    tolerance: float
    tile_level: float

    @cached_property
    def films(self) -> np.ndarray:
        """(R, n) in the film's unit."""
        return np.array([result.film for result in self.results], float)

    @cached_property
    def errors(self) -> np.ndarray:
        """(R, n)."""
        return (self.films - self.scale.value) / self.scale.unit

    @property
    def complete(self) -> bool:
        """Whether the step can be judged."""
        return len(self.results) >= self.replicates

    @property
    def declared(self) -> bool:
        """Whether the method says that its film does not depend on the seed."""
        return self.results[0].deterministic

    @cached_property
    def identical(self) -> bool:
        """Whether all films are one and the same."""
        return bool((self.films == self.films[0]).all())

    @property
    def noiseless(self) -> bool:
        """Whether there is no noise to judge by: one film is all there is, or all are the same."""
        return self.declared or (self.identical and len(self.films) > 1)

    @cached_property
    def repeated(self) -> bool:
        """Whether two films came of one stream of random numbers."""
        return statistics.repeats(self.films)

    @cached_property
    def bias(self) -> np.ndarray:
        """Mean over replicates minus reference, (J + 1 + n,)."""
        return self.scale.pooled(self.errors.mean(axis=0))

    @cached_property
    def standard_error(self) -> np.ndarray:
        """Standard error of the bias, (J + 1 + n,), from the spread of the pooled values; NaN for a single noisy film."""
        if self.noiseless:
            return np.zeros_like(self.bias)
        return statistics.standard_error(self.scale.pooled(self.errors))

    @cached_property
    def quantile(self) -> np.ndarray:
        """q of every interval, (J + 1 + n,), 0 without noise; the tiles' as if there were TILES of them, whatever the film."""
        if self.noiseless:
            return np.zeros_like(self.bias)
        elements = len(self.scale.value)
        return np.repeat([statistics.simultaneous_quantile(self.tile_level, TILES + 1, len(self.films)),
                          statistics.simultaneous_quantile(ELEMENT_LEVEL, elements, len(self.films))],
                         [self.scale.tiles + 1, elements])

    @cached_property
    def noise(self) -> np.ndarray:
        """Half-width due to noise, q s / sqrt(R), (J + 1 + n,)."""
        return self.quantile * self.standard_error

    @cached_property
    def uncertainty(self) -> np.ndarray:
        """Half-width U that no sample reduces: of the reference and of the output's steps, (J + 1 + n,)."""
        quantization = np.max([np.broadcast_to(result.quantization, self.scale.unit.shape) for result in self.results], axis=0)
        return self.scale.pooled((self.scale.uncertainty + quantization) / self.scale.unit)

    @property
    def element_error(self) -> np.ndarray:
        """Standard error (n,) of every element's mean, in the film's unit."""
        return self.standard_error[self.scale.tiles + 1:] * self.scale.unit

    @property
    def half_width(self) -> np.ndarray:
        """Of every interval, (J + 1 + n,)."""
        return self.noise + self.uncertainty

    @property
    def reach(self) -> np.ndarray:
        """How far from zero every interval reaches, (J + 1 + n,)."""
        return np.abs(self.bias) + self.half_width

    @property
    def outside(self) -> np.ndarray:
        """-1 or +1 where an interval lies wholly below or above the tolerance, else 0, (J + 1 + n,)."""
        return np.sign(self.bias) * (np.abs(self.bias) - self.half_width > self.tolerance)

    @property
    def unlit(self) -> np.ndarray:
        """Where light is due and no sample of a method that does not aim at lights has reached any, (J + 1 + n,); the mean
        of a film with such a tile lacks its light too."""
        black = ~self.scale.pooled(np.abs(self.films).max(axis=0)).astype(bool)
        unlit = black & self.scale.lit & (not self.results[0].samples_lights)
        unlit[self.scale.tiles] |= unlit[:self.scale.tiles].any()
        return unlit

    @cached_property
    def leap(self) -> np.ndarray:
        """How far a single sample could have moved each bias at most, (J + 1 + n,); 0 where the method does not know. Where that
        is far, what scatter there is says little: the samples that matter are too rare to have been seen."""
        known = [result.peak for result in self.results if result.peak is not None]
        if not known:
            return np.zeros_like(self.bias)
        films = self.results[:1] if self.noiseless else self.results
        elements = np.max(known, axis=0) / self.scale.unit / sum(film.samples for film in films)
        return np.concatenate([statistics.tile_shares(elements, self.scale.grid), [elements.max() / len(elements)], elements])

    @property
    def blind(self) -> np.ndarray:
        """Where a single sample could have moved the bias by more than the tolerance, (J + 1 + n,)."""
        return self.leap > self.tolerance

    @property
    def unseen(self) -> np.ndarray:
        """Samples at which no single one could move the bias by more than the tolerance, (J + 1 + n,): infinite where a sample
        knows no bound, 0 where the interval does not lie outside the tolerance or the samples are enough."""
        return np.where(self.blind & (self.outside != 0), np.ceil(self.samples * self.leap / self.tolerance), 0)

    @cached_property
    def suspects(self) -> np.ndarray:
        """-1 or +1 where an interval lies wholly below or above the tolerance and noise leaves it narrow, else 0,
        (J + 1 + n,)."""
        steady = self.noiseless | ((self.standard_error > 0) & (self.noise <= WIDEST_VOTE * self.tolerance))
        return self.outside * (steady & ~(self.unlit & (self.bias < 0)))

    @property
    def votes(self) -> np.ndarray:
        """-1 or +1 where an interval votes for a bias below or above the tolerance, else 0, (J + 1 + n,)."""
        return self.suspects * ~self.blind

    @cached_property
    def bound(self) -> np.ndarray:
        """How far off each element is at most, as the method proves of its films (n,); infinite where it does not."""
        proven = [result.bound for result in self.results if result.bound is not None]
        return np.max(proven, axis=0) / self.scale.unit if proven else np.full(len(self.scale.value), np.inf)

    @property
    def disproves(self) -> np.ndarray:
        """Where an element's light is farther off than its `bound` says, (n,)."""
        slack = self.uncertainty[self.scale.tiles + 1:]
        return np.abs(self.errors).max(axis=0) > self.bound + slack

    @property
    def passes(self) -> bool:
        """Whether every tile and the mean lie inside the tolerance (every element, without noise) and no element is suspect."""
        judged = self.reach if self.noiseless else self.reach[:self.scale.tiles + 1]
        return bool((judged <= self.tolerance).all()) and not self.suspects.any()

    @property
    def detectable_bias(self) -> float:
        """The smallest bias of a tile or of the mean that this step would nearly always have told from zero."""
        seen = self.uncertainty + (self.quantile + POWER) * self.standard_error
        return float(seen[:self.scale.tiles + 1].max())

    @property
    def samples_needed(self) -> int | None:
        """Samples at which noise would let this noisy step's intervals into the tolerance, at least those of the next step;
        None where no number of samples can be told to, for an interval without noise lies outside, U alone is too wide or a
        single sample knows no bound."""
        tiles = slice(0, self.scale.tiles + 1)
        hopeless = (self.standard_error == 0) & (self.reach > self.tolerance) & ~self.blind | (self.uncertainty >= self.tolerance)
        if hopeless[tiles].any() or np.isinf(self.unseen).any():
            return None
        excess = ((self.quantile + POWER) * self.standard_error)[tiles].max() / self.tolerance
        by_noise = np.ceil(self.samples * excess**2) if excess > 1 else FACTOR * self.samples
        return int(max(by_noise, self.unseen.max()))

    @property
    def rmse(self) -> float:
        """Root mean square over elements and replicates of a single film's error."""
        return float(np.sqrt((self.errors**2).mean()))

    def stopped_shrinking(self, before: Rung) -> np.ndarray:
        """Where the error without noise falls no longer, (J + 1 + n,): neither there nor, for sums over grids converge by fits
        and starts, over all of the film that some sample has met, which has settled."""
        met = ~self.unlit[self.scale.tiles + 1:]
        error, moved = self.errors[0][met], (self.errors[0] - before.errors[0])[met]
        settled = np.linalg.norm(moved) < SETTLED * np.linalg.norm(error)
        return (np.abs(self.bias) > SHRINKING * np.abs(before.bias)) & settled

    def agrees(self, before: Rung) -> bool:
        """Whether two steps without noise give the same film."""
        return bool((np.abs(self.errors[0] - before.errors[0]) <= SAME_FILM).all())


def climb(results: Sequence[Result], scene: Scene, scale: Scale, triples: int = TRIPLES, replicates: int = 2) -> list[Rung]:
    """The steps of one method on one scene, by samples asked for. A whole step has as many films as any step had trials, and
    at least `replicates`, unless the method declares that it has no noise (then one is enough)."""
    steps: dict[int, list[Result]] = {}
    for result in results:
        if result.status is Status.OK:
            steps.setdefault(result.trial.samples, []).append(result)
    tile_level = TILE_LEVEL * min(1.0, np.sqrt(TRIPLES / triples))
    fullest = max([replicates, *Counter(result.trial.samples for result in results).values()])
    return [_rung(samples, steps[samples], fullest, scale, scene.tolerance, tile_level) for samples in sorted(steps)]


def _rung(samples: int, results: list[Result], fullest: int, scale: Scale, tolerance: float, tile_level: float) -> Rung:
    whole = 1 if results[0].deterministic else fullest
    return Rung(samples, tuple(results), whole, scale, tolerance, tile_level)
