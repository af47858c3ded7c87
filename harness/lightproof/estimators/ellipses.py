"""A bound for the error of Gauss's rule, from how far the integrand stays analytic around the interval.

With |f| at most M on the ellipse around [-1, 1] with foci -1 and 1 and semi-axes that add up to rho, f's Chebyshev coefficients
are at most 2 M rho^-k. The rule of m points is exact up to degree 2m - 1, and the mean of T_k and the rule differ by 4/3 at most
from there on: the error of the mean is (8/3) M rho^-2m / (1 - rho^-2) at most (as Trefethen 2008, "Is Gauss quadrature better
than Clenshaw-Curtis?", theorem 4.5). A rule over a box errs by no more than the sum over its coordinates, each with M over the
real box of the others, for weights are positive.

Here f = (area per ds dt) A B / (d . d)^2 with d from the element to the light; A = d . n of the receiver depends on the light's
point alone, B = -d . n of the light on the element's point alone. Where the box's d has a length of `near` at least, and the
coordinate leads Re d farther by e at most and Im d to i, |d . d| is (near - e)^2 - i^2 at least.
"""

from __future__ import annotations

import math

import numpy as np

from lightproof.estimators.boxes import KIND, U, density, part
from lightproof.estimators.compiled import strict
from lightproof.estimators.vectors import TINY, norm
from lightproof.estimators.world import DISK, PARALLELOGRAM

ORDERS = np.array([(1, 1, 1, 1), (2, 2, 2, 2), (3, 3, 5, 5)])  # nodes along p, q, s, t of a coarse to a fine rule
TRIES = 6  # ellipses, from one that reaches
FARTHEST = 0.45  # of `near` beyond the interval to one that reaches about
LEAST = 4  # half-lengths beyond it


@strict
def rule_error(most, half, beyond, order):
    """Of a coordinate whose half-length is `half`, by an ellipse with the long semi-axis half + beyond."""
    long = half + beyond
    rho = (long + math.sqrt(long * long - half * half)) / half
    return 8 / 3 * most * rho ** (-2 * order) / (1 - 1 / (rho * rho))


@strict
def errors(box, light, halves, near, high, orders):
    """The part of each coordinate in the error of the mean over a box by a rule of so many `orders`; `halves` as `reaches` gives
    them, `high` the largest A and B."""
    return (smallest(box, light, 0, halves[0], near, high, orders[0]), smallest(box, light, 1, halves[1], near, high, orders[1]),
            smallest(box, light, 2, halves[2], near, high, orders[2]), smallest(box, light, 3, halves[3], near, high, orders[3]))


@strict
def smallest(box, light, k, half, near, high, order):
    """The best of a few ellipses; a coordinate without extent has no error."""
    if half == 0:
        return 0.0
    beyond, least = FARTHEST * near, np.inf
    ratio = min(LEAST * half / max(beyond, TINY), 0.2) ** (1 / (TRIES - 1))
    for _ in range(TRIES):
        least, beyond = min(least, error(box, light, k, half, beyond, near, high, order)), ratio * beyond
    return least


@strict
def error(box, light, k, half, beyond, near, high, order):
    """The bound from one ellipse, which is to lead `beyond` [m] farther than the box; infinite where that is too far."""
    aside = math.sqrt(beyond * (2 * half + beyond))
    farther = beyond
    if k == 3 and light[KIND] == DISK:
        radius = box[5] * norm(part(light, U))
        turned = aside / radius
        farther, aside = beyond + radius * (math.cosh(turned) - 1), radius * math.sinh(turned)
    short = max(near - farther, 0.0)
    square = short * short - aside * aside
    if square <= 0:
        return np.inf
    extra = farther + aside
    a, b = (high[0], high[1] + extra) if k < 2 else (high[0] + extra, high[1])
    wide = box[5]
    if k == 2 and light[KIND] != PARALLELOGRAM:
        wide += (box[5] - box[4]) / 2 * (extra / half)
    return rule_error(density(light, wide) * a * b / (square * square), half, beyond, order)
