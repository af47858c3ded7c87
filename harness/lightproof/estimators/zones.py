"""Light inside closed shapes whose walls are lit evenly: a sphere, whole or in two zones, perhaps around another one; a room
whose walls all glow and reflect alike; a cube around a point light in its centre.

Each wall is a zone of reflectance rho, glowing with Le; F[i, j] is the share of zone j in what zone i sees, weighted by the
cosine. Light that was reflected m times leaves the zones with the radiances (R F)^m Le, R = diag(rho). Inside a sphere the form
factor from anywhere to dA is dA/(4 pi r^2): what it reflects is even, wherever it came from.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from lightproof import geometry
from lightproof.geometry import Cap, Polygon, Sphere
from lightproof.scene import PointLight, Scene, Surface

SAME = 1e-12  # of a size: what differs by less is the same


@dataclass(frozen=True)
class Zones:
    """`surfaces` of an enclosure, their `shares` (n, n) in what each sees, and the mean irradiance `lit` (n,) straight from the
    point lights [W/m2]."""

    surfaces: tuple[Surface, ...]
    shares: np.ndarray
    lit: np.ndarray

    @property
    def reflectance(self) -> np.ndarray:
        return np.array([surface.reflectance for surface in self.surfaces])

    def irradiance(self, bounces: float) -> np.ndarray:
        """Even part (n,) of the irradiance on each zone after up to `bounces` reflections: all but `lit` [W/m2]."""
        glow = self.sum(bounces + 1) @ np.array([surface.radiance for surface in self.surfaces])
        reflected = self.sum(bounces) @ (self.reflectance * self.lit)
        return self.shares @ (np.pi * glow + reflected)

    def sum(self, terms: float) -> np.ndarray:
        """The sum (n, n) of so many powers of R F, from 0 on; by its eigenvalues, so that 1 - rho^n does not cancel."""
        values, vectors = np.linalg.eig(self.reflectance[:, None] * self.shares)
        return np.real(vectors @ np.diag([geometric(float(np.real(value)), terms) for value in values]) @ np.linalg.inv(vectors))


def geometric(ratio: float, terms: float) -> float:
    """1 + ratio + ... of so many terms (inf: all), without cancellation near 1."""
    if ratio == 1:
        return float(terms)
    power = np.expm1(terms * np.log(ratio)) if ratio > 0.5 else ratio**terms - 1
    return float(-power / (1 - ratio))


def sphere_zones(scene: Scene) -> Zones | str:
    """The zones of a sphere seen from inside, of one around another, or of one in two caps; or why there are none."""
    inner = tuple(surface for surface in scene.surfaces if surface.side == "inside")
    core = tuple(surface for surface in scene.surfaces if surface.side != "inside")
    if len(inner) == 1 and isinstance(inner[0].shape, Sphere):
        return around(scene, inner[0], core)
    caps = all(isinstance(surface.shape, Cap) for surface in inner)
    if core or len(inner) != 2 or not caps or not inner[0].shape.completes(inner[1].shape):
        return "reflected light has a closed form only inside one sphere, whole or of two caps that complete each other; path can"
    return two_caps(scene, inner)


def around(scene: Scene, wall: Surface, core: tuple[Surface, ...]) -> Zones | str:
    if not core:
        return Zones((wall,), np.ones((1, 1)), mean_lit(scene, wall, 1))
    ball = core[0].shape
    if len(core) > 1 or not isinstance(ball, Sphere) or ball.center != wall.shape.center or ball.radius >= wall.shape.radius:
        return f"reflected light in the sphere '{wall.id}' has a closed form only around one concentric sphere; path can"
    if scene.lights:
        return f"the closed form of light between '{core[0].id}' and '{wall.id}' takes no lights besides them; path can"
    seen = (ball.radius / wall.shape.radius) ** 2
    rest = float(1 - (Fraction(ball.radius) / Fraction(wall.shape.radius)) ** 2)
    return Zones((wall, core[0]), np.array([[rest, seen], [1, 0]]), np.zeros(2))


def two_caps(scene: Scene, caps: tuple[Surface, ...]) -> Zones | str:
    centred = all(light.position == caps[0].shape.center for light in scene.lights if isinstance(light, PointLight))
    if not centred and caps[0].reflectance != caps[1].reflectance:
        return f"its closed form of zones as '{caps[0].id}' takes point lights in the centre only; path can"
    shares = np.sin(np.radians([surface.shape.half_angle / 2 for surface in caps])) ** 2
    return Zones(caps, np.tile(shares, (2, 1)), mean_lit(scene, caps[0], 2))


def mean_lit(scene: Scene, wall: Surface, zones: int) -> np.ndarray:
    """I/r^2 of point lights anywhere inside, the mean over the wall [W/m2]."""
    return np.full(zones, sum(light.intensity for light in scene.lights) / wall.shape.radius**2)


def room_zones(scene: Scene) -> Zones | str:
    """The one zone of a room whose walls are alike; or why there is none."""
    walls = scene.surfaces
    if not is_closed(walls):
        return "reflected light has a closed form only in closed rooms and spheres; path can"
    if len({(wall.reflectance, wall.radiance) for wall in walls}) > 1:
        return "reflected light in a room has a closed form only where all walls reflect and glow alike; path can"
    if not scene.lights:
        return Zones(walls[:1], np.ones((1, 1)), np.zeros(1))
    if not all(isinstance(light, PointLight) and is_cube_around(walls, light.position) for light in scene.lights):
        return "light that a room's walls reflect has a closed form only around a point light in the centre of a cube; path can"
    flux = 4 * np.pi * sum(light.intensity for light in scene.lights)
    return Zones(walls[:1], np.ones((1, 1)), np.array([flux / sum(wall.shape.area for wall in walls)]))


def is_closed(walls: tuple[Surface, ...]) -> bool:
    """Whether polygons close round a room and face inward: each edge is run through once either way."""
    if not walls or not all(isinstance(wall.shape, Polygon) for wall in walls):
        return False
    loops = [wall.shape.vertices for wall in walls]
    edges = [edge for loop in loops for edge in zip(loop, (*loop[1:], loop[0]), strict=True)]
    volume = sum(float(np.dot(loop[0], geometry.vector_area(np.array(loop)))) for loop in loops)
    return sorted(edges) == sorted((end, start) for start, end in edges) and volume < 0


def is_cube_around(walls: tuple[Surface, ...], center: geometry.Vec3) -> bool:
    """Whether six squares with equal sides, each at the same distance from a point, close round it."""
    offsets = [np.array(wall.shape.vertices) - center for wall in walls]
    if len(walls) != 6 or any(len(corners) != 4 for corners in offsets):
        return False
    half = np.sqrt(walls[0].shape.area) / 2
    square = all(abs(wall.shape.area - 4 * half**2) <= SAME * half**2 for wall in walls)
    corners = np.concatenate(offsets)
    away = np.abs(np.linalg.norm(corners, axis=1) - np.sqrt(3) * half).max()
    levels = [abs(corners[0] @ wall.shape.normal + half) for corners, wall in zip(offsets, walls, strict=True)]
    return bool(square and away <= SAME * half and max(levels) <= SAME * half)
