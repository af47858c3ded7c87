"""What a picture of a scene's set-up shows, as Mitsuba's plugins: lamps with pale backs, blockers, the film as a grid.

A picture is lit twice, by the scene's own lights and by a white surrounding that leaves nothing black. What is large is
cut where the picture ends, and a sphere seen from inside is cut open.
"""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from lightproof import geometry
from lightproof.geometry import Cap, Disk, Polygon, Shape, Sphere
from lightproof.renderers import mesh, mitsuba_shapes
from lightproof.reporting import framing
from lightproof.scene import AreaLight, CameraFilm, DirectionalLight, Light, PlaneFilm, PointLight, PointsFilm, Scene, Surface

LAMP, LAMP_BACK = (0.99, 0.93, 0.72), (0.95, 0.80, 0.42)
BLOCKER, RIM, SKY, SKY_OFF = (0.16, 0.20, 0.28), (0.42, 0.47, 0.55), (0.55, 0.85, 1.35), (0.4, 0.5, 0.6)
CELLS = (0.64, 0.65, 0.67), (0.50, 0.52, 0.55)
WARM = (1.0, 0.93, 0.77)
INK, DOT = (0.13, 0.27, 0.58), (0.80, 0.16, 0.14)
SHEET, LINE, BULB = 2e-3, 2.5e-3, 1.3e-2  # thickness of sheets and radii of lines and dots, of the picture's size
OPEN = 0.25  # how far in front of a sphere's centre it is cut open, of its radius
FRUSTUM = 0.4  # where the camera's frame is drawn, of the way to its target


class Stage:
    """Mitsuba's plugins of one picture (`parts`) and the points (n, 3) [m] that have to be in it (`points`).

    `lit`: the scene's lights shine; otherwise they are pale things like all others.
    """

    def __init__(self, mi: ModuleType, scene: Scene, lit: bool):
        self.mi = mi
        self.lit = lit
        self.box = framing.region(scene)
        self.parts: dict[str, Any] = {}
        self.corners: list[np.ndarray] = []
        for light in scene.lights:
            self._light(light)
        for surface in scene.surfaces:
            self._surface(surface)
        self._film(scene.film)

    @property
    def points(self) -> np.ndarray:
        """All points that have to be in the picture."""
        return np.concatenate(self.corners)

    def _light(self, light: Light) -> None:
        match light:
            case AreaLight():
                lamp = mitsuba_shapes.build(self.mi, light.shape, self._lamp(light.radiance))
                self._add(lamp, mesh.tessellate(light.shape).vertices)
                if isinstance(light.shape, Polygon | Disk):
                    self._add(mitsuba_shapes.build(self.mi, _back(light.shape, SHEET * self.box.size), paint(LAMP_BACK)))
            case PointLight():
                bulb = Sphere(light.position, BULB * self.box.size)
                self._add(mitsuba_shapes.build(self.mi, bulb, self._lamp(light.intensity / (np.pi * bulb.radius**2))),
                          mesh.tessellate(bulb).vertices)
            case DirectionalLight():
                self._beam(light)
            case _:
                self._dome(upper=getattr(light, "extent", "upper") == "upper")

    def _lamp(self, radiance: float) -> dict[str, Any]:
        return {"emitter": {"type": "area", "radiance": warm(radiance)}} if self.lit else paint(LAMP)

    def _beam(self, light: DirectionalLight) -> None:
        if self.lit:
            self._add({"type": "directional", "direction": list(light.direction), "irradiance": warm(light.irradiance)})
        way = 0.3 * self.box.size * geometry.unit(light.direction)
        for offset in np.array(geometry.tangents(light.direction)) * 0.15 * self.box.size:
            for start in (-offset, offset):
                self._rod((self.box.low + self.box.high) / 2 + start - 2 * way, (self.box.low + self.box.high) / 2 + start - way)

    def _dome(self, upper: bool) -> None:
        """The far half of a sky, as a bowl; above the horizon only where the sky is."""
        centre = (self.box.low + self.box.high) / 2
        sky = _cut(mesh.tessellate(Sphere(tuple(centre), 0.62 * self.box.size), inside=True), centre, framing.towards_viewer())
        if upper:
            sky = _cut(sky, np.array([0, 0, min(0, self.box.low[2])]), np.array([0.0, 0, -1]))
        self._triangles(sky, {"emitter": {"type": "area", "radiance": rgb(SKY)}} if self.lit else paint(SKY_OFF))

    def _surface(self, surface: Surface) -> None:
        colour = (surface.reflectance,) * 3 if surface.reflectance else BLOCKER
        content = paint(colour)
        if surface.radiance and self.lit:
            content["emitter"] = {"type": "area", "radiance": warm(surface.radiance)}
        if surface.side == "inside" and isinstance(surface.shape, Sphere | Cap):
            self._bowl(surface.shape, content)
        elif isinstance(surface.shape, Polygon):
            self._sheet(framing.clipped(surface.shape, self.box.grown(framing.BEYOND)), content)
        else:
            self._add(mitsuba_shapes.build(self.mi, surface.shape, content, surface.side == "inside"),
                      mesh.tessellate(surface.shape).vertices)

    def _sheet(self, corners: np.ndarray, content: dict[str, Any]) -> None:
        if len(corners) >= 3:
            self._triangles(mesh.tessellate(Polygon(tuple(map(tuple, corners)))), content)

    def _bowl(self, sphere: Sphere | Cap, content: dict[str, Any]) -> None:
        """A sphere, or a part of one, cut open: its inner face, and the rim of the cut."""
        towards = framing.towards_viewer()
        edge = np.array(sphere.center) + OPEN * sphere.radius * towards
        self._triangles(_cut(mesh.tessellate(sphere, inside=True), edge, towards), content)
        self._triangles(_ring(edge, towards, sphere.radius * (1 - OPEN**2) ** 0.5), paint(RIM))

    def _film(self, film: PlaneFilm | PointsFilm | CameraFilm) -> None:
        match film:
            case PlaneFilm():
                self._grid(film)
            case PointsFilm():
                for position, normal in zip(film.positions, film.normals or (), strict=False):
                    self._dot(np.array(position))
                    self._rod(np.array(position), np.array(position) + 0.08 * self.box.size * geometry.unit(normal))
            case CameraFilm():
                self._frustum(film)

    def _grid(self, film: PlaneFilm) -> None:
        columns, rows = film.resolution
        u, v, lift = np.array(film.u), np.array(film.v), SHEET * self.box.size * film.normal
        corners = np.array(film.origin) + lift / 2 + np.array([0 * u, u, u + v, v])
        cells = {"type": "checkerboard", "color0": rgb(CELLS[0]), "color1": rgb(CELLS[1]),
                 "to_uv": self.mi.ScalarTransform4f().scale([columns / 2, rows / 2, 1])}
        self._add(mitsuba_shapes.rectangle(self.mi, corners, two_sided(cells)), corners)
        self._outline(corners)

    def _frustum(self, film: CameraFilm) -> None:
        right, up, forward = geometry.camera_frame(film.origin, film.target, film.up)
        origin, reach = np.array(film.origin), FRUSTUM * float(np.linalg.norm(np.subtract(film.target, film.origin)))
        width, height = np.array(film.half_extent) * (reach if film.projection == "perspective" else 1)
        signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
        frame = origin + reach * forward + signs * (width, height) @ np.stack([right, up])
        self._dot(origin)
        self._outline(frame)
        for corner in frame:
            self._rod(origin, corner)

    def _outline(self, corners: np.ndarray) -> None:
        for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            self._rod(start, end)

    def _rod(self, start: np.ndarray, end: np.ndarray) -> None:
        rod = {"type": "cylinder", "p0": start.tolist(), "p1": end.tolist(), "radius": LINE * self.box.size / 2, **paint(INK)}
        self._add(rod, np.array([start, end]))

    def _dot(self, centre: np.ndarray) -> None:
        self._add({"type": "sphere", "center": centre.tolist(), "radius": 0.8 * BULB * self.box.size, **paint(DOT)}, centre[None])

    def _triangles(self, shape: mesh.Mesh, content: dict[str, Any]) -> None:
        self._add(mitsuba_shapes.triangles(self.mi, shape, content), shape.vertices[np.unique(shape.triangles)])

    def _add(self, part: Any, points: np.ndarray | None = None) -> None:
        self.parts[f"part-{len(self.parts)}"] = part
        if points is not None:
            self.corners.append(points)


def paint(colour: tuple[float, float, float]) -> dict[str, Any]:
    """Both faces of a shape in one colour."""
    return two_sided(rgb(colour))


def two_sided(reflectance: dict[str, Any]) -> dict[str, Any]:
    """Both faces of a shape with one diffuse reflectance."""
    return {"bsdf": {"type": "twosided", "front": {"type": "diffuse", "reflectance": reflectance}}}


def rgb(colour: tuple[float, float, float]) -> dict[str, Any]:
    """A linear colour."""
    return {"type": "rgb", "value": list(colour)}


def warm(value: float) -> dict[str, Any]:
    """A radiometric value, tinted as lamps are."""
    return rgb(tuple(value * part for part in WARM))


def _back(shape: Polygon | Disk, gap: float) -> Shape:
    """The same shape turned round, `gap` behind the front."""
    if isinstance(shape, Disk):
        normal = geometry.unit(shape.normal)
        return Disk(tuple(shape.center - gap * normal), tuple(-normal), shape.radius)
    return Polygon(tuple(map(tuple, (np.array(shape.vertices) - gap * shape.normal)[::-1])))


def _cut(shape: mesh.Mesh, point: np.ndarray, normal: np.ndarray) -> mesh.Mesh:
    """What lies behind the plane through `point`; the triangles that cross it are pressed flat against it."""
    height = (shape.vertices - point) @ normal
    kept = (height[shape.triangles] < 0).any(axis=1)
    return mesh.Mesh(shape.vertices - np.maximum(height, 0)[:, None] * normal, shape.triangles[kept])


def _ring(centre: np.ndarray, normal: np.ndarray, radius: float) -> mesh.Mesh:
    """A narrow flat ring."""
    inner, outer = (mesh.tessellate(Disk(tuple(centre), tuple(normal), part * radius)).vertices[:-1] for part in (0.985, 1.02))
    here = np.arange(len(inner))
    following = np.roll(here, -1)
    triangles = [np.stack(corners, axis=1) for corners in ((here, here + len(inner), following),
                                                          (following, here + len(inner), following + len(inner)))]
    return mesh.Mesh(np.vstack([inner, outer]), np.vstack(triangles))
