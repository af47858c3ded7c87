"""Monte Carlo over the solid angle of the lights."""

from __future__ import annotations

from lightproof.estimators.mc_aimed import McAimed
from lightproof.estimators.subtended import Subtended


class McSolidAngle(McAimed):
    """Near a light the density of its directions knows no limit and needs none."""

    domain = "solid angle of the light"
    density = "1/(solid angle) per solid angle; of a disk, within a factor of two of that"
    aim = Subtended
