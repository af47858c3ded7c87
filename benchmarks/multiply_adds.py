"""The most multiply-adds that this machine's cores do in a second: chains in registers that do not wait for one another."""

from __future__ import annotations

import numpy as np
from numba import njit

from lightproof.estimators.compiled import STRICT  # and with it the registers that kernels take

LENGTH, CHAIN = 1024, 8  # numbers that stay in the first cache; multiply-adds of each between load and store


@njit(fastmath=STRICT, nogil=True, error_model="numpy")
def multiply_add(values, factor, summand, rounds):
    """`CHAIN` multiply-adds of each of `values` (LENGTH,) float32, `rounds` times."""
    for _ in range(rounds):
        for i in range(LENGTH):
            value = values[i]
            for _ in range(CHAIN):
                value = value * factor + summand
            values[i] = value


def operations(rounds: int) -> float:
    """Floating-point operations of a call: a multiply-add is two."""
    return 2.0 * rounds * LENGTH * CHAIN


def arguments(rounds: int) -> tuple[np.ndarray, np.float32, np.float32, int]:
    """Numbers that stay where they are."""
    return np.ones(LENGTH, np.float32), np.float32(0.5), np.float32(0.5), rounds


def assembly() -> str:
    """Of the compiled function."""
    multiply_add(*arguments(1))
    return next(iter(multiply_add.inspect_asm().values()))
