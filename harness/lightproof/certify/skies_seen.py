"""The sky as a camera sees it: what is left of a pixel beside everything else."""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb

from lightproof import scene
from lightproof.certify import planes, quadrature
from lightproof.certify.balls import Ball, CannotCertify, Number, dot, exact, point, root, unit
from lightproof.certify.camera import Camera
from lightproof.certify.planes import Line, Patch, Region
from lightproof.scene import Light


def lines(camera: Camera) -> set[Line]:
    """The film positions of the horizon, where there is one."""
    level = [camera.ray(x, y)[1][2] for x, y in ((0, 0), (1, 0), (0, 1))]
    return {planes.scaled((level[0], level[1] - level[0], level[2] - level[0]))} - {None}


def radiance(lights: Sequence[Light], camera: Camera, region: Region) -> Number:
    """Mean radiance over a region of the film that the horizon does not cross. Raises CannotCertify."""
    return sum((SKIES[type(light)](light, camera, region) for light in lights if type(light) in SKIES), arb(0))


def _uniform(light: scene.Environment, camera: Camera, region: Region) -> Number:
    return exact(light.radiance) if light.extent == "sphere" or _above(camera, region) else arb(0)


def _above(camera: Camera, region: Region) -> bool:
    return camera.ray(*planes.centre(region))[1][2] > 0


def _overcast(light: scene.OvercastSky, camera: Camera, region: Region) -> Number:
    """The mean of L_z (1 + 2 sin(elevation)) / 3."""
    if not _above(camera, region):
        return arb(0)
    sines = sum((_integral(camera, patch) for patch in planes.patches(region)), arb(0))
    return exact(light.zenith_radiance) / 3 * (1 + 2 * sines / planes.area(region))


def _integral(camera: Camera, patch: Patch) -> arb:
    """The integral of sin(elevation) over a patch."""

    def integrand(s: Ball, t: Ball) -> Ball:
        _, along = camera.ray(*patch.at(s, t))
        return patch.jacobian(s, t) * along[2] / root(dot(along, along))

    return quadrature.integral(integrand)


def _sun(light: scene.SunDisc, camera: Camera, region: Region) -> Number:
    """All of it where all corners see it, for it is convex. Raises CannotCertify where its rim may be seen."""
    edge = (arb.pi() * exact(light.half_angle) / 180).cos()

    def inside(x: Number, y: Number) -> arb:
        _, along = camera.ray(x, y)
        return -dot(along, unit(point(light.direction))) - edge * root(dot(along, along))

    if all(inside(*corner) > 0 for corner in region):
        return exact(light.radiance)
    if inside(*(arb.union(arb(min(axis)), arb(max(axis))) for axis in zip(*region, strict=True))) < 0:
        return arb(0)
    raise CannotCertify(f"the rim of '{light.id}' may cross a pixel; a sun is covered where pixels see all of it or nothing")


SKIES = {scene.Environment: _uniform, scene.OvercastSky: _overcast, scene.SunDisc: _sun}
