"""Monte Carlo by points of the lights and directions of the hemisphere, combined: E ~ (1/N) sum L V cos(theta) / p."""

from __future__ import annotations

from lightproof.estimators.mc_area import McArea
from lightproof.estimators.mixed import Mixed
from lightproof.estimators.pieces import Piece, aimed
from lightproof.estimators.views import View
from lightproof.scene import Scene


class McMis(McArea):
    """As mc-area, with values that a near light does not lift above 2 pi L."""

    domain = "area of the light and hemisphere of the receiver, in turn"
    density = "half the sum of r^2/(cos A) and cos/pi per solid angle: the balance heuristic"
    traces = False

    def sources(self, scene: Scene, seen: View) -> list[Piece]:
        return aimed(scene, seen, Mixed)
