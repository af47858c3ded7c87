"""Irradiance per radiance, in closed form: disk, sphere, distant disc and skies, in forms that do not cancel."""

from __future__ import annotations

import math

from lightproof.estimators import gauss
from lightproof.estimators.compiled import strict
from lightproof.estimators.vectors import along, dot, norm

SLIVER = 0.5  # rad above the horizon: a sphere that rises less is summed, for Snyder's terms cancel
NODES, WEIGHTS = gauss.rule(20)


@strict
def disk(center, normal, radius, n):
    """A disk wholly above the horizon; `center` is relative to the receiver, whose normal is n.

    Its vector irradiance has a part along the disk's axis, (pi/2)(1 - P/S), and one towards that axis, 2 pi h a r^2/(S (S + Q)),
    with P, Q = h^2 + a^2 -+ r^2 and S^2 = Q^2 - 4 r^2 a^2 (Howell's catalogue, disk and parallel or perpendicular element)."""
    h = -dot(center, normal)
    if h <= 0:
        return 0.0
    towards = along(center, h, normal)
    a, r2 = norm(towards), radius * radius
    p, q = h * h + (a - radius) * (a + radius), h * h + a * a + r2
    s = math.hypot(p, 2 * radius * h)
    upright = 2 * r2 * h * h / (s * (s + p)) if p > 0 else (s - p) / (2 * s)
    return math.pi * (2 * h * r2 / (s * (s + q)) * dot(towards, n) - upright * dot(normal, n))


@strict
def sphere(d, z, radius):
    """A sphere at distance d, its centre z above the receiver's plane: whole, cut by the horizon (Snyder 1996), its top alone
    above the horizon, or below."""
    if z >= radius:
        return math.pi * radius * radius * z / (d * d * d)
    if z <= -radius or d <= radius:
        return 0.0
    across, tangent = math.sqrt((d - z) * (d + z)), math.sqrt((d - radius) * (d + radius))
    if z < 0:
        top = math.asin((radius - z) * (radius + z) / (radius * across - z * tangent))
        if top < SLIVER:
            return sliver(top, math.atan2(z, across), math.atan2(radius, tangent))
    cosine, h2 = z / d, (d / radius) * (d / radius)
    x = tangent / radius
    w = math.sqrt((radius - z) * (radius + z)) / radius
    return (cosine * math.atan2(w, -x * cosine) - x * w) / h2 + math.atan2(w, x)


@strict
def sliver(top, elevation, half_angle):
    """What rises above the horizon of a cone of directions whose axis is below it: the sum over elevations p of sin p cos p times
    the azimuths 2 f that the cone holds there, sin^2(f/2) = sin((half_angle + p - elevation)/2) sin((top - p)/2) /
    (cos(elevation) cos p). With p = top (1 - t^2) the root at the top is gone."""
    total = 0.0
    for i in range(len(NODES)):
        t = NODES[i]
        p = top * (1 - t) * (1 + t)
        square = math.sin((half_angle + p - elevation) / 2) * math.sin(top * t * t / 2) / (math.cos(elevation) * math.cos(p))
        total += WEIGHTS[i] * t * math.sin(p) * math.cos(p) * math.asin(min(math.sqrt(square), 1.0))
    return 8 * top * total


@strict
def upper_sky(tilt_cosine):
    """A uniform sky above z = 0 on a plane whose normal has this third component: pi (1 + cos b)/2."""
    return math.pi * (1 + tilt_cosine) / 2


@strict
def overcast_sky(tilt_cosine):
    """The CIE overcast sky of zenith radiance 1: (1/3) of a uniform sky's, and (2/3) of the integral of sin(elevation) cos(theta)
    over the lune that sky and receiver share, (2/3)(sin b + (pi - b) cos b)."""
    tilt_sine = math.sqrt(max(1 - tilt_cosine * tilt_cosine, 0.0))
    tilt = math.atan2(tilt_sine, tilt_cosine)
    return upper_sky(tilt_cosine) / 3 + 4 * (tilt_sine + (math.pi - tilt) * tilt_cosine) / 9
