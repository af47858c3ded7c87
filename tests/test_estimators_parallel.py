"""Lights and blockers parallel to the film: half of the arithmetic, the same light."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lightproof import suite
from lightproof.estimators import shapes
from lightproof.estimators.lamps import Glow, Lamp, lamp
from lightproof.estimators.mc_area import McArea
from lightproof.estimators.parallel import Between, Level, levelled

FLOOR = np.array([0.0, 0.0, -0.3]), np.array([0.0, 0.0, 1.0])
EAST, NORTH, UP = np.array([0.9, 0, 0]), np.array([0.1, 0.7, 0]), np.array([0, 0, 1.0])


def flat(height: float, u: np.ndarray = NORTH, v: np.ndarray = EAST) -> shapes.Parallelogram:
    """Faces down, unless told otherwise."""
    return shapes.flat(shapes.Parallelogram, np.array([0.2, 0.1, height]), u, v)


@pytest.mark.parametrize(("name", "blockers"), [("occluded-square", 1), ("two-blockers", 2), ("disk-blocker", 1),
                                                ("l-shaped-light", 0), ("square-light-seen", 0)])
def test_the_same_light_as_without_looking(name, blockers):
    """Sample by sample: the film in float64 is that of pieces which may be tilted, to rounding."""
    made = McArea("mc-area/float64", 1)
    made.prepare(suite.default().scene(name))
    film = made.render(3000, 5).film
    assert all(isinstance(piece.source, Level) for piece in made.pieces)
    assert all(isinstance(one, Between) for piece in made.pieces for one in piece.blockers)
    assert {len(piece.blockers) for piece in made.pieces} == {blockers}
    made.pieces = [replace(one, source=one.lamp, blockers=tuple(each.shape for each in one.blockers)) for one in made.pieces]
    assert made.render(3000, 5).film == pytest.approx(film, rel=1e-11)


def test_only_what_is_parallel_is_taken_for_it():
    """A lamp over the floor is; one that faces away, lies below or tilts by 1e-15 is not, nor is what is not flat. Blockers by
    themselves: one that tilts, or hangs above the lamp, stays as it was."""
    over = lamp(Glow("", flat(1.1), 2.04))
    globe = lamp(Glow("", shapes.Sphere((0.0, 0.0, 1.1), 0.2), 2.04))
    tilted = flat(0.4, NORTH + 1e-15 * UP)
    others = (lamp(Glow("", shape, 2.04)) for shape in (flat(1.1, EAST, NORTH), flat(-0.4), tilted))
    for other in (*others, globe):
        assert levelled(other, (flat(0.4),), FLOOR) == (other, (flat(0.4),))
    assert levelled(over, (flat(0.4),), None) == (over, (flat(0.4),))
    found, blockers = levelled(over, (flat(0.4), tilted, flat(1.2)), FLOOR)
    assert isinstance(found, Level) and isinstance(over, Lamp)
    assert blockers[0].share == pytest.approx(0.5, rel=1e-15) and blockers[1:] == (tilted, flat(1.2))
