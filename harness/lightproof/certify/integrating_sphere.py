"""Light between the parts of a diffuse sphere, where the form factor to an area dA is dA / (4 pi R^2) from everywhere.

What comes off the wall is therefore the same everywhere on it. After n reflections it is E_n = pi <L_e> + <rho D> +
<rho> E_(n-1), in brackets means over the wall, whose zones each have a reflectance rho and a radiance L_e; D is the
irradiance that point lights give the wall straight.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable

from flint import arb

from lightproof import geometry
from lightproof.certify import series
from lightproof.certify.balls import CannotCertify, exact
from lightproof.scene import PointLight, Scene


def from_wall(scene: Scene, last: int | str) -> arb:
    """Irradiance on the wall from the wall after up to `last` reflections [W/m2]. Raises CannotCertify."""
    zones = [(_share(zone.shape), zone) for zone in scene.surfaces]
    kept = sum((share * exact(zone.reflectance) for share, zone in zones), arb(0))
    own = arb.pi() * sum((share * exact(zone.radiance) for share, zone in zones), arb(0))
    return own * series.geometric(kept, last) + kept * _spread(scene) * series.geometric(kept, series.before(last))


def _share(zone: geometry.Sphere | geometry.Cap) -> arb:
    """Of the whole sphere's area."""
    return (arb.pi() * exact(zone.half_angle) / 360).sin() ** 2 if isinstance(zone, geometry.Cap) else arb(1)


def _spread(scene: Scene) -> arb:
    """Irradiance from the point lights alone, its mean over each zone [W/m2]. Raises CannotCertify."""
    aside = [light.id for light in scene.lights if not is_central(light, scene)]
    if aside and not _alike(zone.reflectance for zone in scene.surfaces):
        raise CannotCertify(f"point light '{aside[0]}' is off the centre of zones of different reflectance")
    return evenly(scene.lights, scene)


def is_central(light: PointLight, scene: Scene) -> bool:
    """Whether a point light is in the sphere's centre."""
    return light.position == scene.surfaces[0].shape.center


def evenly(lights: Iterable[PointLight], scene: Scene) -> arb:
    """Irradiance of point lights spread evenly over the wall [W/m2]."""
    return arb(sum((exact(light.intensity) for light in lights), exact(0)) / exact(scene.surfaces[0].shape.radius) ** 2)


def uniform(scene: Scene) -> arb:
    """The wall's radiance where it is the same everywhere. Raises CannotCertify where it is not."""
    even = all(is_central(light, scene) for light in scene.lights)
    if not (even and _alike((zone.reflectance, zone.radiance) for zone in scene.surfaces)):
        raise CannotCertify("the film is not on the wall, and the wall's radiance differs from place to place")
    last = scene.max_bounces
    return series.leaving(scene.surfaces[0], _spread(scene) + from_wall(scene, series.before(last)), last)


def _alike(values: Iterable[Hashable]) -> bool:
    return len(set(values)) == 1
