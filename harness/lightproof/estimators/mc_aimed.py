"""Monte Carlo by directions aimed at each light: E ~ (1/N) sum L V cos(theta) / p. What the domains that do so share."""

from __future__ import annotations

from typing import ClassVar

from lightproof.estimators.aims import Aim
from lightproof.estimators.mc_area import McArea
from lightproof.estimators.pieces import Piece, aimed
from lightproof.estimators.views import View
from lightproof.scene import Scene


class McAimed(McArea):
    """As mc-area, with directions that `aim` draws in the place of points."""

    aim: ClassVar[type[Aim]]
    traces = False

    def sources(self, scene: Scene, seen: View) -> list[Piece]:
        return aimed(scene, seen, self.aim.of)
