"""Points and weights over a film element's unit square."""

from __future__ import annotations

import numpy as np

ORDER = 4  # of the Gauss-Legendre rule of a cell, where there are several


def square(samples: int) -> np.ndarray:
    """(m, 3): p, q in [-1/2, 1/2] and weights that add up to 1, m near `samples`: one product Gauss rule of up to ORDER
    nodes a side, beyond that cells of such rules, whose size can shrink past a shadow's edges."""
    side = max(1, round(samples**0.5))
    order, cells = (side, 1) if side <= ORDER else (ORDER, round(side / ORDER))
    x, weight = np.polynomial.legendre.leggauss(order)
    nodes = ((np.arange(cells)[:, None] + (1 + x) / 2) / cells - 0.5).ravel()
    weights = np.tile(weight / 2, cells) / cells
    p, q = np.meshgrid(nodes, nodes)
    return np.column_stack([p.ravel(), q.ravel(), np.outer(weights, weights).ravel()])
