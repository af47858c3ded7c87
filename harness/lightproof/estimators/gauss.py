"""Gauss-Legendre rules on [0, 1]."""

from __future__ import annotations

from functools import cache

import numpy as np


@cache
def rule(order: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights (order,), read-only; the weights add up to 1."""
    nodes, weights = np.polynomial.legendre.leggauss(order)
    found = (1 + nodes) / 2, weights / 2
    for array in found:
        array.setflags(write=False)
    return found


def table(highest: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights (highest + 1, highest) of every order up to `highest`: row k holds those of order k, then zeros."""
    nodes, weights = np.zeros((2, highest + 1, highest))
    for order in range(1, highest + 1):
        nodes[order, :order], weights[order, :order] = rule(order)
    return nodes, weights
