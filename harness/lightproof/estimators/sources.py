"""What the closed forms ask of a source of light, whatever its kind; each kind overloads both for its own type."""

from __future__ import annotations

from numba.extending import overload


def desk(source):
    """Room to work in, for one thread."""


def irradiance(source, desk, x, n):
    """At x on the side to which n points, of any length, from the source past what blocks it [W/m2]."""


def is_round(source):
    """Whether its light fades like a root of the distance behind a curve, as that of round shapes does."""


@overload(is_round)
def _is_round(source):
    found = getattr(getattr(source, "instance_class", None), "ROUND", False)
    return (lambda source: True) if found else (lambda source: False)
