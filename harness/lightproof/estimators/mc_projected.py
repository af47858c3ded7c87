"""Monte Carlo over the projected solid angle of spheres: E = pi sin(a)^2 cos(theta) L times the mean of V."""

from __future__ import annotations

from lightproof.estimators.limits import no_flat_lights
from lightproof.estimators.mc_area import McArea
from lightproof.estimators.pieces import Piece, aimed
from lightproof.estimators.projected import Projected
from lightproof.estimators.views import View
from lightproof.scene import Scene


class McProjected(McArea):
    """As mc-solid-angle, where lights are spheres."""

    domain = "projected solid angle of the light"
    density = "cos/(projected solid angle) per solid angle; 1/(solid angle) of a sphere that the horizon cuts"
    traces = False
    limits = (*McArea.limits, no_flat_lights)

    def sources(self, scene: Scene, seen: View) -> list[Piece]:
        return aimed(scene, seen, Projected)
