"""Paths under way, side by side in one array: each step is one loop over all of them, which runs in vector registers.

The rows of the array are SIZE numbers each, one after the other; since their distances are constants, the compiler sees that
no row overlaps another. A row that holds a vector is three rows.
"""

from __future__ import annotations

from lightproof.estimators.compiled import inlined, strict

SIZE = 128  # paths in a batch: all its rows stay in a core's first cache
PLACE, NORMAL, WAY, FACE = (SIZE * row for row in (0, 3, 6, 9))
BEND, WEIGHT, TOTAL, REACH, LIGHT, GLOW, REFLECTED = (SIZE * row for row in range(12, 19))
ROWS = 19
FULL = 0.8  # of the paths going on: fewer are worth to be moved together
KEPT = (*range(0, 6 * SIZE, SIZE), WEIGHT, TOTAL)  # what a path takes along from one vertex to the next


@inlined
def at(state, row, i):
    """The vector of path i."""
    return state[row + i], state[row + SIZE + i], state[row + 2 * SIZE + i]


@inlined
def put(state, row, i, v):
    state[row + i], state[row + SIZE + i], state[row + 2 * SIZE + i] = v


@strict
def settle(state, slots, totals, count):
    """Writes down what the paths have gathered, each in its place."""
    for i in range(count):
        totals[slots[i]] = state[TOTAL + i]


@strict
def keep(state, slots, totals, count, going):
    """Where many fewer paths are `going` on than are there: settles all and moves those, whose weight is not 0, to the front.
    Returns how many are there now. A path of weight 0 that stays changes nothing."""
    if going > FULL * count:
        return count
    kept = 0
    for i in range(count):
        slot, weight = slots[i], state[WEIGHT + i]
        totals[slot] = state[TOTAL + i]
        slots[kept] = slot
        for row in KEPT:
            state[row + kept] = state[row + i]
        kept += weight > 0
    return kept
