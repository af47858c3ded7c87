"""How the error of a method falls with the number N of its samples, in theory. README.md prints the same.

Errors are root mean squares. What is sampled has two coordinates at a receiver that is a point, and four where its element has
an extent. `shadowed` is an integrand that jumps across a curve, `smooth` one that does not.

Sources: Owen 1997, "Scrambled net variance for integrals of smooth functions"; Mitchell 1996, "Consequences of stratified
sampling in graphics"; He and Wang 2015, "On the convergence rate of randomized quasi-Monte Carlo for discontinuous functions".
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class Rate:
    """The error falls as N to a power from `flattest` to `steepest`, times log N to the power `logs`."""

    flattest: Fraction
    steepest: Fraction
    logs: Fraction = Fraction(0)

    def __str__(self) -> str:
        powers = dict.fromkeys((self.flattest, self.steepest))
        logarithm = f" (log N)^{self.logs}" if self.logs else ""
        return " to ".join(f"N^{power}" for power in powers) + logarithm

    def slopes(self, samples: float) -> tuple[float, float]:
        """Steepest and flattest d log(error) / d log(N) around so many samples: logarithms flatten it for long."""
        return float(self.steepest), float(self.flattest) + float(self.logs) / math.log(samples)


@dataclass(frozen=True)
class Rates:
    """By what is sampled: `point`, over two coordinates, or with the `element`, over four; smooth, then shadowed."""

    point: tuple[Rate, Rate]
    element: tuple[Rate, Rate]


def rate(*powers: str, logs: str = "0") -> Rate:
    """Of one power, or of the flattest and the steepest that theory knows."""
    return Rate(Fraction(powers[0]), Fraction(powers[-1]), Fraction(logs))


POINTS = {
    "independent": Rates((rate("-1/2"), rate("-1/2")), (rate("-1/2"), rate("-1/2"))),
    "jitter": Rates((rate("-1"), rate("-3/4")), (rate("-1/2", "-1"), rate("-1/2", "-3/4"))),
    "lattice": Rates((rate("-1"), rate("-3/4")), (rate("-1"), rate("-5/8"))),
    "sobol": Rates((rate("-3/2", logs="1/2"), rate("-3/4")), (rate("-3/2", logs="3/2"), rate("-5/8"))),
}
GRIDS = {
    "riemann-area": Rates((rate("-1"), rate("-1/2", "-3/4")), (rate("-1/2"), rate("-1/4", "-5/8"))),
    "riemann-hemisphere": Rates((rate("-1"), rate("-1/2", "-3/4")), (rate("-1/3", "-2/3"), rate("-1/3", "-2/3"))),
}

# What is sampled: points of the light's area, onto whose triangles the unit square is folded; directions into the light; the same
# in proportion to what they contribute; or directions of the hemisphere, to which a light's outline is an edge.
AREA, CONE, PROJECTED, HEMISPHERE = "area", "cone", "projected", "hemisphere"
DOMAINS = {
    "riemann-area": AREA,
    "riemann-hemisphere": HEMISPHERE,
    "mc-area": AREA,
    "mc-hemisphere": HEMISPHERE,
    "mc-cosine": HEMISPHERE,
    "mc-solid-angle": CONE,
    "mc-projected-solid-angle": PROJECTED,
    "mc-mis": HEMISPHERE,
    "path": AREA,
}
