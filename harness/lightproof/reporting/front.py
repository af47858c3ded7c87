"""What no other method beats: of all measured films those than which none is both as fast and as exact."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from lightproof.renderers.registry import is_ours
from lightproof.reporting.evaluation import Cell
from lightproof.reporting.wording import percent, seconds

ALL = "all methods"
SAMPLING = "ours that sample"
EXTERNAL = "external renderers"
FLOOR = 1e-6  # an error as small is as good as none


@dataclass(frozen=True)
class Place:
    """A step of a method: the render seconds and the rms error (a fraction) of one film."""

    method: str
    seconds: float
    error: float


def samples(cell: Cell) -> bool:
    """Whether a method is ours and draws random samples."""
    return is_ours(cell.method) and not cell.final[0].deterministic


def external(cell: Cell) -> bool:
    """Whether a method is somebody else's, a reader's own included."""
    return not is_ours(cell.method)


GROUPS: dict[str, Callable[[Cell], bool]] = {ALL: lambda cell: True, SAMPLING: samples, EXTERNAL: external}


def pareto(places: Iterable[Place]) -> list[Place]:
    """The front, from the fastest to the most exact."""
    front: list[Place] = []
    for place in sorted(places, key=lambda place: (place.seconds, place.error)):
        if not front or place.error < front[-1].error:
            front.append(place)
    return front


def fronts(cells: Sequence[Cell]) -> dict[str, list[Place]]:
    """The front of each group of the usable methods that has any; a group that is the same as all is left out."""
    usable = [cell for cell in cells if cell.usable]
    members = {name: [cell for cell in usable if belongs(cell)] for name, belongs in GROUPS.items()}
    found = {name: pareto(place for cell in group for place in places(cell)) for name, group in members.items()}
    return {name: front for name, front in found.items() if front and (name == ALL or front != found[ALL])}


def places(cell: Cell) -> list[Place]:
    """Every step of a method."""
    return [Place(cell.method, step.seconds_render, max(step.rmse, FLOOR)) for step in cell.drawable]


def in_words(front: Sequence[Place]) -> str:
    """The methods of a front in order of time, each with the first and the last of the films that put it there."""
    return "; ".join(_member([place for place in front if place.method == method])
                     for method in dict.fromkeys(place.method for place in front))


def _member(stretch: Sequence[Place]) -> str:
    first, last = stretch[0], stretch[-1]
    start = f"{first.method}, {_film(first)}"
    return start if first is last else f"{start} to {_film(last)}"


def _film(place: Place) -> str:
    error = percent(place.error) if place.error > FLOOR else f"under {percent(FLOOR, 1)}"
    return f"{error} in {seconds(place.seconds)}"
