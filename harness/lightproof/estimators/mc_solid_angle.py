"""Monte Carlo over the solid angle of the lights: E ~ (1/N) sum L V cos(theta) / p, directions w drawn into each light."""

from __future__ import annotations

from lightproof.estimators.mc_area import McArea
from lightproof.estimators.pieces import Piece, aimed
from lightproof.estimators.subtended import Subtended
from lightproof.estimators.views import View
from lightproof.scene import Scene


class McSolidAngle(McArea):
    """As mc-area, with directions in the place of points; near a light their density knows no limit and needs none."""

    domain = "solid angle of the light"
    density = "1/(solid angle) per solid angle; of a disk, within a factor of two of that"
    traces = False

    def sources(self, scene: Scene, seen: View) -> list[Piece]:
        return aimed(scene, seen, Subtended)
