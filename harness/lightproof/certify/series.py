"""Light reflected again and again: what n reflections add up to, and what all of them do."""

from __future__ import annotations

from flint import arb, arb_mat

from lightproof.certify.balls import Ball, exact
from lightproof.scene import Surface


def total(step: arb_mat, first: arb_mat, last: int | str) -> arb_mat:
    """first + step first + ... + step^last first, nothing where `last` is negative; without an end where it is "all".

    Finite sums stand in the corner of a power of the block matrix (step 1; 0 1): nothing is divided, so that nothing is lost
    where `step` is all but 1.
    """
    size = step.nrows()
    if last == "all":
        return (arb_mat(size, size, 1) - step).solve(first)
    block = arb_mat([[step[i, j] for j in range(size)] + [int(i == j) for j in range(size)] for i in range(size)]
                    + [[0] * size + [int(i == j) for j in range(size)] for i in range(size)])
    power = block ** max(last + 1, 0)
    return arb_mat([[power[i, size + j] for j in range(size)] for i in range(size)]) * first


def geometric(ratio: Ball, last: int | str) -> arb:
    """1 + ratio + ... + ratio^last, or without an end."""
    return 1 / (1 - arb(ratio)) if last == "all" else total(arb_mat([[ratio]]), arb_mat([[1]]), last)[0, 0]


def before(last: int | str) -> int | str:
    """One reflection less."""
    return last if last == "all" else last - 1


def leaving(surface: Surface, irradiance: arb, last: int | str) -> arb:
    """Radiance of a surface: its own, and what it reflects where any of `last` reflections is left for it."""
    return exact(surface.radiance) + (exact(surface.reflectance) / arb.pi() * irradiance if last != 0 else arb(0))
