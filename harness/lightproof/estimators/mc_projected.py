"""Monte Carlo over the projected solid angle of the lights: E is that times L times the mean of V."""

from __future__ import annotations

from lightproof.estimators.mc_aimed import McAimed
from lightproof.estimators.projected import Projected


class McProjected(McAimed):
    """What nothing hides has no noise, but of disks and of spheres that the horizon cuts."""

    domain = "projected solid angle of the light"
    density = "cos/(projected solid angle) per solid angle; of a disk and of a sphere that the horizon cuts as mc-solid-angle"
    aim = Projected
