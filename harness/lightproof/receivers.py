"""Where the light of a scene is measured: films of cells, of points, and of a camera's pixels, frozen and validated."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from lightproof import checked, geometry
from lightproof.checked import Checked, SceneError
from lightproof.geometry import Vec3


@dataclass(frozen=True)
class PlaneFilm(Checked):
    """A rectangle of cells; a cell's value is the mean irradiance over its area. Row r, column c starts at
    origin + u c/columns + v r/rows; the receiving side is u x v."""

    TAG = ("kind", "plane")

    quantity: str = checked.choice("irradiance")
    origin: Vec3 = checked.vector()
    u: Vec3 = checked.direction()
    v: Vec3 = checked.direction()
    resolution: tuple[int, int] = checked.resolution()

    def check(self) -> None:
        u, v = geometry.unit(self.u), geometry.unit(self.v)
        if np.linalg.norm(np.cross(u, v)) < geometry.FRAME:
            raise SceneError("v", "v is parallel to u; give two directions that span a plane")

    @property
    def grid(self) -> tuple[int, int]:
        """(rows, columns)."""
        return self.resolution[::-1]

    @property
    def normal(self) -> np.ndarray:
        """Unit normal of the receiving side, (3,)."""
        return geometry.unit(np.cross(geometry.unit(self.u), geometry.unit(self.v)))


@dataclass(frozen=True)
class PointsFilm(Checked):
    """Points that receive: irradiance on the side of `normals`, or the solid angle of all lights [sr] (without normals:
    from the whole sphere)."""

    TAG = ("kind", "points")

    quantity: str = checked.choice("irradiance", "solid_angle")
    positions: tuple[Vec3, ...] = checked.vectors(least=1)
    normals: tuple[Vec3, ...] | None = checked.vectors(least=1, each=checked.to_direction, default=None)

    def check(self) -> None:
        if self.normals is None and self.quantity == "irradiance":
            raise SceneError("normals", "irradiance needs a normal for each position")
        if self.normals is not None and len(self.normals) != len(self.positions):
            raise SceneError("normals", f"{len(self.normals)} normals for {len(self.positions)} positions; give as many of each")

    @property
    def grid(self) -> tuple[int, int]:
        """(1, points)."""
        return 1, len(self.positions)


@dataclass(frozen=True)
class CameraFilm(Checked):
    """A pinhole camera without near clip; a pixel's value is the mean radiance over its square, uniform in film area.
    Row 0 on top, columns along (target - origin) x up. `fov` [degrees] (perspective) or `width` [m] (orthographic) is
    that across all columns; pixels are square."""

    TAG = ("kind", "camera")

    quantity: str = checked.choice("radiance")
    projection: str = checked.choice("perspective", "orthographic")
    origin: Vec3 = checked.vector()
    target: Vec3 = checked.vector()
    up: Vec3 = checked.direction()
    resolution: tuple[int, int] = checked.resolution()
    fov: float = checked.number(least=0, most=179, default=0.0)
    width: float = checked.number(least=0, default=0.0)

    def check(self) -> None:
        geometry.camera_frame(self.origin, self.target, self.up)
        needed, other = ("fov", "width") if self.projection == "perspective" else ("width", "fov")
        if not getattr(self, needed) or getattr(self, other):
            raise SceneError(needed, f"a {self.projection} camera takes {needed}, greater than 0, and no {other}")

    @property
    def grid(self) -> tuple[int, int]:
        """(rows, columns)."""
        return self.resolution[::-1]

    @property
    def half_extent(self) -> tuple[float, float]:
        """Half width and half height of the film: as tangents (perspective) or in metres (orthographic)."""
        half = math.tan(math.radians(self.fov) / 2) if self.projection == "perspective" else self.width / 2
        columns, rows = self.resolution
        return half, half * rows / columns


Film = PlaneFilm | PointsFilm | CameraFilm
