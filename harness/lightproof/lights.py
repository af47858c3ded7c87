"""What shines and reflects in a scene: lights and surfaces, frozen and validated, each named and in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from lightproof import checked, geometry
from lightproof.checked import Checked, SceneError
from lightproof.geometry import Shape, Vec3


def _shape() -> Any:
    def check(value: Any) -> Shape:
        is_one = isinstance(value, tuple(geometry.SHAPES.values()))
        return value if is_one else checked.by_tag(value, "type", geometry.SHAPES).from_table(value)

    return checked.rule(check, {"$ref": "#/$defs/shape"})


@dataclass(frozen=True)
class AreaLight(Checked):
    """A surface that emits `radiance` [W/(m2 sr)] from its front, the same in every direction, and reflects nothing."""

    TAG = ("kind", "area")

    id: str = checked.identifier()
    shape: Shape = _shape()
    radiance: float = checked.number(least=0)


@dataclass(frozen=True)
class PointLight(Checked):
    """A point that emits `intensity` [W/sr], the same in every direction."""

    TAG = ("kind", "point")

    id: str = checked.identifier()
    position: Vec3 = checked.vector()
    intensity: float = checked.number(least=0)


@dataclass(frozen=True)
class DirectionalLight(Checked):
    """A collimated beam; `direction` is that of travel, `irradiance` [W/m2] that of a plane across the beam."""

    TAG = ("kind", "directional")

    id: str = checked.identifier()
    direction: Vec3 = checked.direction()
    irradiance: float = checked.number(least=0)


@dataclass(frozen=True)
class Environment(Checked):
    """Uniform `radiance` [W/(m2 sr)] from every direction, or from those with z > 0 only (`extent = "upper"`)."""

    TAG = ("kind", "environment")

    id: str = checked.identifier()
    radiance: float = checked.number(least=0)
    extent: str = checked.choice("sphere", "upper", default="sphere")


@dataclass(frozen=True)
class SunDisc(Checked):
    """A distant disc of `radiance` [W/(m2 sr)] within `half_angle` [degrees] around where its light comes from;
    `direction` is that of travel."""

    TAG = ("kind", "environment")

    id: str = checked.identifier()
    radiance: float = checked.number(least=0)
    direction: Vec3 = checked.direction()
    half_angle: float = checked.number(above=0, most=90)


@dataclass(frozen=True)
class OvercastSky(Checked):
    """The CIE standard overcast sky above z = 0: radiance `zenith_radiance` (1 + 2 sin(elevation)) / 3 [W/(m2 sr)]."""

    TAG = ("kind", "environment")

    id: str = checked.identifier()
    zenith_radiance: float = checked.number(least=0)
    sky: str = checked.choice("cie-overcast", default="cie-overcast")


Light = AreaLight | PointLight | DirectionalLight | Environment | SunDisc | OvercastSky


@dataclass(frozen=True)
class Surface(Checked):
    """A Lambertian surface of `reflectance`, black behind; it may emit a `radiance` [W/(m2 sr)] of its own."""

    TAG = ("kind", "lambertian")

    id: str = checked.identifier()
    shape: Shape = _shape()
    reflectance: float = checked.number(least=0, most=1)
    radiance: float = checked.number(least=0, default=0.0)
    side: str = checked.choice("outside", "inside", default="outside")

    def check(self) -> None:
        if self.side == "inside" and not isinstance(self.shape, geometry.Sphere | geometry.Cylinder | geometry.Cap):
            raise SceneError("side", "only a sphere, a cap or a cylinder has an inside; turn the vertices or the normal round")
