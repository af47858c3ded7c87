"""Directions of the hemisphere: the family of densities (k + 1)/(2 pi) cos^k per solid angle, uniform for k = 0."""

from __future__ import annotations

import math

from lightproof.estimators.compiled import strict, strict_kernel
from lightproof.estimators.rng import mix64, stream, uniform
from lightproof.estimators.tracing import receive, seen
from lightproof.estimators.vectors import along, scaled, tangents


@strict
def cosine_power(power, s, t):
    """A direction around the third axis from s, t uniform in [0, 1], with density (power + 1)/(2 pi) cos^power."""
    z = 1 - s if power == 0 else math.sqrt(1 - s)
    r = math.sqrt(max(1 - z * z, 0.0))
    return r * math.cos(2 * math.pi * t), r * math.sin(2 * math.pi * t), z


@strict
def oriented(w, n):
    """`w`, given around the third axis, around the unit vector n."""
    t, b = tangents(n)
    return along(along(scaled(w[2], n), w[0], t), w[1], b)


@strict_kernel
def estimate(items, skies, film, elements, contact, first, seed, samples, power, out):
    """E ~ (1/N) sum L cos / pdf_solid_angle, directions with density ~ cos^power; sums of the value and of its square over
    samples `samples[0]` to `samples[1]` of each of `elements`; `out` (n, 2)."""
    for e in range(len(elements)):
        total, square = 0.0, 0.0
        for i in range(samples[0], samples[1]):
            key = stream(seed, first + e, i)
            value, factor, x, n = receive(items, skies, film, elements[e], uniform(key, 0) - 0.5, uniform(key, 1) - 0.5, contact)
            if factor > 0:
                key = mix64(key)
                w = cosine_power(power, uniform(key, 0), uniform(key, 1))
                per_density = 2 * math.pi * w[2] if power == 0 else math.pi
                value += factor * per_density * seen(items, skies, x, oriented(w, n), contact)
            total += value
            square += value * value
        out[e, 0], out[e, 1] = total, square
