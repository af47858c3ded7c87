"""Rows of arrays as vectors, for compiled code."""

from __future__ import annotations

from lightproof.estimators.compiled import strict


@strict
def point(rows, i):
    """Row i of an array (m, 3)."""
    return rows[i, 0], rows[i, 1], rows[i, 2]
