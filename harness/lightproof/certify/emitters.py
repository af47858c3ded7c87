"""The irradiance that each kind of light gives a receiver when nothing blocks it, as analytic functions of the receiver.

A formula may hold on one side of a plane only: the receiver in front of the light, the light whole above the horizon. For
the receivers of one plane that is decided here, once and exactly.
"""

from __future__ import annotations

from collections.abc import Callable

from flint import acb, arb

from lightproof import geometry, scene
from lightproof.certify import balls
from lightproof.certify.balls import Ball, CannotCertify, Number, Rational, Vector, dot, exact, minus, point, root, unit
from lightproof.certify.planes import Plane

Formula = Callable[[Vector], Ball]  # receiver -> irradiance [W/m2]


def dark(x: Vector) -> Ball:
    """No light."""
    return arb(0)


def point_light(light: scene.PointLight, receiver: Plane) -> Formula:
    """E = I cos(theta) / r^2."""
    position, normal = point(light.position), unit(receiver.normal)
    if receiver.height(position) <= 0:
        return dark

    def irradiance(x: Vector) -> Ball:
        ray = minus(position, x)
        squared = dot(ray, ray)
        return exact(light.intensity) * dot(ray, normal) / (squared * root(squared))

    return irradiance


def beam(light: scene.DirectionalLight, receiver: Plane) -> Formula:
    """E = E_0 cos(theta)."""
    cosine = -dot(unit(point(light.direction)), unit(receiver.normal))
    value = exact(light.irradiance) * cosine if dot(point(light.direction), receiver.normal) < 0 else arb(0)
    return lambda x: value


def uniform_sky(light: scene.Environment, receiver: Plane) -> Formula:
    """E = pi L from all round; pi L (1 + cos b) / 2 from above the horizon alone, on a plane tilted by b."""
    share = (1 + unit(receiver.normal)[2]) / 2 if light.extent == "upper" else arb(1)
    return lambda x: arb.pi() * exact(light.radiance) * share


def overcast_sky(light: scene.OvercastSky, receiver: Plane) -> Formula:
    """E = (L_z / 3) (pi (1 + cos b) / 2 + (4/3) ((pi - b) cos b + sin b)): 7 pi L_z / 9 on the horizontal (b = 0)."""
    cosine = unit(receiver.normal)[2]
    flat = receiver.normal[0] == receiver.normal[1] == 0
    sine = arb(0) if flat else root(1 - cosine * cosine)
    tilt = arb.atan2(sine, cosine)
    diffuse = arb.pi() * (1 + cosine) / 2 + ((arb.pi() - tilt) * cosine + sine) * 4 / 3
    return lambda x: exact(light.zenith_radiance) / 3 * diffuse


def sun(light: scene.SunDisc, receiver: Plane) -> Formula:
    """A disc of half-angle a is as good as a sphere of radius sin(a) at distance 1; of 90 degrees, as half a sky."""
    radius = (arb.pi() * exact(light.half_angle) / 180).sin()
    height = -dot(unit(point(light.direction)), unit(receiver.normal))
    if light.half_angle == 90:
        value = arb.pi() * exact(light.radiance) * (1 + height) / 2
        return lambda x: value
    above = _above(height, radius)
    value = exact(light.radiance) * _sphere(radius, arb(1), height, above) if above else arb(0)
    return lambda x: value


def sphere_light(shape: geometry.Sphere, radiance: float, receiver: Plane) -> Formula:
    """Whole: E = pi L (R/d)^2 cos(theta); cut by the horizon: Snyder 1996. The height above a plane is the same everywhere."""
    centre, radius, normal = point(shape.center), exact(shape.radius), unit(receiver.normal)
    height = dot(minus(centre, _foot(receiver)), normal)
    above = _exactly_above(receiver.height(centre), radius**2 * dot(receiver.normal, receiver.normal))
    if not above:
        return dark

    def irradiance(x: Vector) -> Ball:
        ray = minus(centre, x)
        square = dot(ray, ray)
        if not isinstance(square, acb) and square <= radius * radius:
            raise CannotCertify("a receiver is inside a sphere light, or on it")
        return exact(radiance) * _sphere(radius, square, height, above)

    return irradiance


def _above(height: arb, radius: Number) -> str:
    """How a sphere stands to the horizon: "whole" above it, "cut" by it, or "" below it."""
    if height >= radius:
        return "whole"
    if height > -radius and height < radius:
        return "cut"
    if height <= -radius:
        return ""
    raise balls.Undecided("the light touches the receiver's horizon too closely to tell on which side it is")


def _exactly_above(height: Rational, squared_reach: Rational) -> str:
    """The same in exact numbers, of any unit, for a sphere that may touch the horizon."""
    if height * height < squared_reach:
        return "cut"
    return "whole" if height > 0 else ""


def _sphere(radius: Number, squared: Ball, height: arb, above: str) -> Ball:
    """Irradiance per radiance [sr] from a sphere whose centre is the root of `squared` away and `height` above the horizon.

    Snyder's formula with w = sin(theta) sqrt(1 - y^2) = sqrt(1 - (height/R)^2), which is the same for a whole plane.
    """
    distance = root(squared)
    share = radius * radius / squared
    if above == "whole":
        return arb.pi() * share * height / distance
    level = height / radius
    x, w = root(squared / (radius * radius) - 1), root(1 - level * level)
    arc = arb.pi() / 2 + balls.arctan(x * height / (distance * w))
    return share * (height / distance * arc - x * w) + balls.arctan(w / x)


def disk_light(shape: geometry.Disk, radiance: float, receiver: Plane) -> Formula:
    """Lambert's contour integral around the rim of a disk that is whole above the horizon, which is elementary: a rational
    function of cosines over one turn."""
    centre, radius = point(shape.center), exact(shape.radius)
    axis, normal = unit(point(shape.normal)), unit(receiver.normal)
    height, tilt = dot(minus(centre, _foot(receiver)), normal), dot(axis, normal)

    def irradiance(x: Vector) -> Ball:
        ray = minus(centre, x)
        along = dot(ray, axis)
        squared = dot(ray, ray)
        across = squared - along * along
        p = squared + radius * radius
        q = p - 2 * radius * radius
        d = root(q * q + 4 * radius * radius * along * along)
        bend = tilt * across - (height - along * tilt) * along
        return -arb.pi() * exact(radiance) * radius * radius * (tilt - 2 * bend / (p + d)) / d

    return irradiance


def _foot(plane: Plane) -> Vector:
    """A point of the plane."""
    return tuple(component * plane.offset / dot(plane.normal, plane.normal) for component in plane.normal)

