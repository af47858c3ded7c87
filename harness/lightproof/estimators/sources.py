"""What the closed forms ask of a source of light, whatever its kind; each kind overloads both for its own type."""

from __future__ import annotations


def desk(source):
    """Room to work in, for one thread."""


def irradiance(source, desk, x, n):
    """At x on the side to which n points, of any length, from the source past what blocks it [W/m2]."""
