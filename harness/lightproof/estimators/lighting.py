"""Light that arrives at a point from one point of each light of a `World`: the integrand of the area form."""

from __future__ import annotations

import math

from lightproof.estimators.compiled import strict
from lightproof.estimators.tracing import free, front_normal, vector
from lightproof.estimators.vectors import along, dot, norm, scaled, sub, tangents
from lightproof.estimators.world import (
    AREA,
    CAP,
    CENTER,
    COSINE,
    DISK,
    KIND,
    NORMAL,
    PARALLELOGRAM,
    POINT,
    RADIANCE,
    RADIUS,
    SIDE,
    SPHERE,
    U,
    V,
)

FAR = 1e15  # contacts: far beyond everything in the scene, for a shadow ray towards a beam


@strict
def spot(item, x, s, t):
    """A point of a light and 1/density per area there [m2], from s, t uniform in [0, 1]. Of a sphere seen from outside
    only the cap that faces x is drawn from."""
    if item[KIND] == SPHERE:
        return spot_on_sphere(item, x, s, t)
    if item[KIND] == CAP:
        n = around(vector(item, NORMAL), s * (1 - item[COSINE]), t)
        return along(vector(item, CENTER), item[RADIUS], n), item[AREA]
    if item[KIND] == PARALLELOGRAM:
        a, b = s - 0.5, t - 0.5
    elif item[KIND] == DISK:
        a, b = math.sqrt(s) * math.cos(2 * math.pi * t), math.sqrt(s) * math.sin(2 * math.pi * t)
    else:
        a, b = (s, t) if s + t <= 1 else (1 - s, 1 - t)
    return along(along(vector(item, CENTER), a, vector(item, U)), b, vector(item, V)), item[AREA]


@strict
def spot_on_sphere(item, x, s, t):
    center, radius = vector(item, CENTER), item[RADIUS]
    away = sub(x, center)
    r = norm(away)
    axis = scaled(1 / r, away) if r > 0 else (0.0, 0.0, 1.0)
    height = max(r - radius, 0.0) / r if item[SIDE] > 0 else 2.0
    return along(center, radius, around(axis, s * height, t)), 2 * math.pi * radius * radius * height


@strict
def around(axis, down, t):
    """The unit vector that is `down` lower along `axis` than its tip, t turns about it."""
    side = math.sqrt(max(down * (2 - down), 0.0))
    e1, e2 = tangents(axis)
    return along(along(scaled(1 - down, axis), side * math.cos(2 * math.pi * t), e1), side * math.sin(2 * math.pi * t), e2)


@strict
def from_item(items, k, x, n, s, t, contact):
    """L V cos(theta_x) cos(theta_y) / (r^2 p) from one point of item k [W/m2]."""
    y, per_density = spot(items[k], x, s, t)
    d = sub(y, x)
    r2 = dot(d, d)
    cosines = max(dot(d, n), 0.0) * max(-dot(d, front_normal(items[k], y)), 0.0)
    if cosines == 0 or not free(items, x, d, contact):
        return 0.0
    return items[k, RADIANCE] * per_density * cosines / (r2 * r2)


@strict
def from_bulb(items, bulb, x, n, contact):
    """Irradiance from a point light or a beam, shadows included [W/m2]."""
    if bulb[0] == POINT:
        d = sub(vector(bulb, 1), x)
        r2 = dot(d, d)
        value = bulb[4] * dot(d, n) / (r2 * math.sqrt(r2))
    else:
        d = scaled(-FAR * contact, vector(bulb, 1))
        value = -bulb[4] * dot(vector(bulb, 1), n)
    return value if value > 0 and free(items, x, d, contact) else 0.0


@strict
def from_bulbs(items, bulbs, x, n, contact):
    """Irradiance from all point lights and beams [W/m2]."""
    total = 0.0
    for k in range(len(bulbs)):
        total += from_bulb(items, bulbs[k], x, n, contact)
    return total
