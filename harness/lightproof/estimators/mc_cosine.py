"""Monte Carlo over the hemisphere in proportion to the cosine: E ~ (pi/N) sum L(w)."""

from __future__ import annotations

from lightproof.estimators.mc_hemisphere import McHemisphere
from lightproof.estimators.meeting import Cosine


class McCosine(McHemisphere):
    """As mc-hemisphere, with another density."""

    density = "cos(theta)/pi per solid angle"
    source = Cosine
