"""Monte Carlo by points of the lights and directions of the hemisphere, combined."""

from __future__ import annotations

from lightproof.estimators.mc_aimed import McAimed
from lightproof.estimators.mixed import Mixed


class McMis(McAimed):
    """Values that a near light does not lift above 2 pi L."""

    domain = "area of the light and hemisphere of the receiver, in turn"
    density = "half the sum of r^2/(cos A) and cos/pi per solid angle: the balance heuristic"
    aim = Mixed
