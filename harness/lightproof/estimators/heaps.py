"""A queue of numbered things by their weight, the heaviest first: a binary heap in an array."""

from __future__ import annotations

from lightproof.estimators.compiled import strict


@strict
def push(heap, count, weights, item):
    """Adds an item to the first `count` of `heap`; returns the new count."""
    at = count
    while at > 0 and weights[heap[(at - 1) // 2]] < weights[item]:
        heap[at] = heap[(at - 1) // 2]
        at = (at - 1) // 2
    heap[at] = item
    return count + 1


@strict
def pop(heap, count, weights):
    """Takes the first item away; returns the new count."""
    count -= 1
    last, at = heap[count], 0
    while 2 * at + 1 < count:
        child = 2 * at + 1
        if child + 1 < count and weights[heap[child + 1]] > weights[heap[child]]:
            child += 1
        if weights[heap[child]] <= weights[last]:
            break
        heap[at] = heap[child]
        at = child
    heap[at] = last
    return count
