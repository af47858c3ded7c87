"""Named configurations of a renderer: what stands behind the / of a method's name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

T = TypeVar("T")


def chosen(name: str, configurations: Mapping[str, T]) -> T:
    """The configuration of mitsuba/scalar is called scalar; that of mitsuba, its best, has no name. Raises ValueError."""
    method, _, option = name.partition("/")
    if option not in configurations:
        known = ", ".join(filter(None, configurations))
        raise ValueError(f"{method} has no configuration {option!a}; there are {known}, and {method} alone for the best")
    return configurations[option]
