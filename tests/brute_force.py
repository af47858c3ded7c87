"""What a receiver sees first in each of many directions, by intersecting rays in numpy: slow, coarse and simple."""

from __future__ import annotations

import numpy as np

from lightproof import geometry, scene


def sphere_of_directions(rings):
    """Unit vectors (n, 3) in the middle of cells of equal solid angle, and that solid angle [sr]."""
    z = (np.arange(rings) + 0.5) / rings * 2 - 1
    f = (np.arange(2 * rings) + 0.5) * np.pi / rings
    z, f = np.meshgrid(z, f, indexing="ij")
    s = np.sqrt(1 - z**2)
    return np.stack([s * np.cos(f), s * np.sin(f), z], axis=-1).reshape(-1, 3), 2 * np.pi / rings**2


def first_seen(scene_, x, w):
    """(n,) The light or surface seen first from x in directions w (n, 3), and whether its front is; None where there is none."""
    things = [thing for thing in (*scene_.lights, *scene_.surfaces) if hasattr(thing, "shape")]
    if not things:
        return np.full(len(w), None), np.zeros(len(w), bool)
    distances = np.array([distance(thing.shape, x, w) for thing in things])
    nearest = distances.argmin(axis=0)
    front = np.array([w @ facing(thing.shape, x) < 0 for thing in things])
    seen = np.array([*things, None])[np.where(distances.min(axis=0) < np.inf, nearest, len(things))]
    return seen, front[nearest, np.arange(len(w))]


def facing(shape, x):
    """A vector against which the front of a flat shape is seen; for a sphere, that to its centre turned round."""
    if isinstance(shape, geometry.Sphere):
        return x - np.array(shape.center)
    return shape.normal if isinstance(shape, geometry.Polygon) else np.array(shape.normal)


def distance(shape, x, w):
    """(n,) Distance to a shape along directions w (n, 3) from x, infinite where they miss it."""
    with np.errstate(divide="ignore", invalid="ignore"):
        if isinstance(shape, geometry.Sphere):
            ray = np.array(shape.center) - x
            along = w @ ray
            left = along**2 - ray @ ray + shape.radius**2
            return np.where((left > 0) & (along > 0), along - np.sqrt(np.maximum(left, 0)), np.inf)
        anchor = shape.vertices[0] if isinstance(shape, geometry.Polygon) else shape.center
        t = (np.array(anchor) - x) @ facing(shape, x) / (w @ facing(shape, x))
        return np.where((t > 0) & _within(shape, x + t[:, None] * w), t, np.inf)


def _within(shape, p):
    """Whether points (n, 3) of a flat shape's plane lie in it; in a polygon by how often a ray to its side crosses the rim."""
    if isinstance(shape, geometry.Disk):
        return ((p - shape.center) ** 2).sum(axis=1) < shape.radius**2
    u, v = (axis for axis in range(3) if axis != np.abs(shape.normal).argmax())
    corners = np.array(shape.vertices)
    inside = np.zeros(len(p), bool)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        spans = (a[v] > p[:, v]) != (b[v] > p[:, v])
        inside ^= spans & (p[:, u] < a[u] + (b[u] - a[u]) * (p[:, v] - a[v]) / (b[v] - a[v]))
    return inside


def sky(light, w):
    """(n,) Radiance of a sky or sun in directions w (n, 3)."""
    match light:
        case scene.SunDisc():
            return light.radiance * (-w @ geometry.unit(light.direction) > np.cos(np.radians(light.half_angle)))
        case scene.OvercastSky():
            return np.where(w[:, 2] > 0, light.zenith_radiance * (1 + 2 * w[:, 2]) / 3, 0)
    return np.where((w[:, 2] > 0) | (light.extent == "sphere"), light.radiance, 0)


def solid_angle(scene_, x, normal=None, rings=500):
    """Visible solid angle of all lights [sr]."""
    w, share = sphere_of_directions(rings)
    seen, front = first_seen(scene_, x, w)
    open_sky = sum((sky(light, w) > 0 for light in scene_.lights if not hasattr(light, "shape")), np.zeros(len(w))) > 0
    lit = np.array([isinstance(thing, scene.AreaLight) for thing in seen]) & front | (seen == None) & open_sky  # noqa: E711
    return share * np.count_nonzero(lit & (w @ normal > 0) if normal is not None else lit)


def sky_irradiance(scene_, x, normal, rings=500):
    """Irradiance [W/m2] from the skies and suns of a scene."""
    w, share = sphere_of_directions(rings)
    seen, _ = first_seen(scene_, x, w)
    radiance = sum(sky(light, w) for light in scene_.lights if not hasattr(light, "shape"))
    return share * float(np.sum(radiance * np.clip(w @ geometry.unit(normal), 0, None) * (seen == None)))  # noqa: E711
