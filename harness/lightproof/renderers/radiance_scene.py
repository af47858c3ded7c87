"""Scenes as Radiance's own text: lights, surfaces and skies, in radiometric units and one channel repeated three times.

Two things are said in a roundabout way so that nothing is approximated. Radiance's surfaces reflect on both sides: a pattern
makes the back black. And Radiance samples a lamp evenly over a parallelogram only: any other lamp is a dark body, seen but
sampled never, with an invisible `illum` before it that shines where a ray through it meets the lamp.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from lightproof import geometry
from lightproof.geometry import Cap, Cylinder, Disk, Polygon, Shape, Sphere
from lightproof.renderers import mesh
from lightproof.renderers.radiance_transport import ROOM, Transport, extent, is_lamp, is_parallelogram, transport_of
from lightproof.scene import AreaLight, DirectionalLight, Environment, Light, OvercastSky, PointLight, Scene, Surface

BEAM = 0.01  # degrees across of the distant disc that stands for a beam
BULB = 1e-5  # radius of the ball that stands for a point, of the scene's extent
BEHIND = 1e-5  # of a flat lamp's size: how far its body lies behind its aperture

SHAPES = """{ Which rays meet a shape.  w: from A1..A3 to the point of the aperture where the ray arrives. }
wx = Px - A1;  wy = Py - A2;  wz = Pz - A3;
ww = sq(wx) + sq(wy) + sq(wz);
wd = wx*Dx + wy*Dy + wz*Dz;
{ disk, sphere: A1..A3 centre, A4 radius }
on_disk = if(sq(A4) - ww, 1, 0);
on_sphere = if(sq(A4) - ww + sq(wd), 1, 0);
{ tube: A1..A3 base, A4..A6 unit axis, A7 height, A8 radius; the ray enters it at its side and not through an end }
wa = wx*A4 + wy*A5 + wz*A6;
da = Dx*A4 + Dy*A5 + Dz*A6;
qb = wd - wa*da;
gap = sq(qb) - (1 - sq(da))*(ww - sq(wa) - sq(A8));
way = (-qb - Sqrt(gap)) / (1 - sq(da));
level = wa + way*da;
on_tube = if(gap, if(way, if(level, if(A7 - level, 1, 0), 0), 0), 0);
{ left: of the edge through A1..A3 with inward normal A4..A6.  cap: A1..A3 centre, A4..A6 unit axis, A7 radius x cosine }
left = if(wa, 1, 0);
on_cap = if(wa - A7, 1, 0);
{ front of a surface; the sky of the CIE }
front = if(Rdot, 1, 0);
overcast = (1 + 2*Dz) / 3;
"""


def describe(scene: Scene, shapes: str) -> str:
    """The scene's text; `shapes` names the file that holds SHAPES."""
    writer = Writer(scene, transport_of(scene), extent(scene), shapes)
    parts = [part for light in scene.lights for part in writer.light(light)]
    parts += [part for surface in scene.surfaces for part in writer.surface(surface)]
    return "\n".join(parts) + "\n"


@dataclass(frozen=True)
class Writer:
    """Radiance's words for lights and surfaces; each method gives the primitives of one."""

    scene: Scene
    transport: Transport
    extent: float
    shapes: str

    def light(self, light: Light) -> Iterator[str]:
        """A light."""
        name = light.id
        match light:
            case AreaLight():
                yield from self._lamp(name, light.shape, light.radiance)
            case PointLight():
                radius = BULB * self.extent
                yield _material("void", "illum", name, _grey(light.intensity / (np.pi * radius**2)), ["void"])
                yield _primitive(name, "sphere", f"{name}-bulb", [*light.position, radius])
            case DirectionalLight():
                solid_angle = 4 * np.pi * np.sin(np.radians(BEAM) / 4) ** 2
                yield _material("void", "light", name, _grey(light.irradiance / solid_angle))
                yield _primitive(name, "source", f"{name}-disc", [*np.negative(light.direction), BEAM])
            case Environment():
                yield _material("void", "glow", name, [*_grey(light.radiance), 0])
                yield _primitive(name, "source", f"{name}-dome", [0, 0, 1, 360 if light.extent == "sphere" else 180])
            case OvercastSky():
                yield self._pattern(f"{name}-cie", "overcast")
                yield _material(f"{name}-cie", "glow", name, [*_grey(light.zenith_radiance), 0])
                yield _primitive(name, "source", f"{name}-dome", [0, 0, 1, 180])

    def surface(self, surface: Surface) -> Iterator[str]:
        """A surface; black where the scene does not reflect."""
        name, inside = surface.id, surface.side == "inside"
        reflectance = surface.reflectance if self.scene.reflects else 0.0
        if is_lamp(surface, self.scene):
            yield from self._lamp(name, surface.shape, surface.radiance)
            return
        yield self._pattern(f"{name}-front", "front")
        if not surface.radiance:
            yield _material(f"{name}-front", "plastic", f"{name}-paint", [*_grey(reflectance), 0, 0])
            yield from self._body(f"{name}-paint", name, surface.shape, inside)
            return
        part = max(min(0.5, 1 - reflectance), 1e-3)  # of the mixture that glows; the rest reflects, and no more than all
        yield _material("void", "glow", f"{name}-glow", [*_grey(surface.radiance / part), 0])
        yield _material(f"{name}-front", "plastic", f"{name}-paint", [*_grey(reflectance / (1 - part)), 0, 0])
        yield f"void mixfunc {name}-mix\n4 {name}-glow {name}-paint {part:.17g} .\n0\n0"
        yield from self._body(f"{name}-mix", name, surface.shape, inside)

    def _lamp(self, name: str, shape: Shape, radiance: float) -> Iterator[str]:
        if is_parallelogram(shape) and self.transport.aims:
            yield _material("void", "light", name, _grey(radiance))
            yield from self._body(name, f"{name}-face", shape)
        elif self.transport.apertures:
            yield _material("void", "glow", f"{name}-glow", [*_grey(radiance), -1])
            yield from self._body(f"{name}-glow", f"{name}-body", shape, behind=BEHIND)
            for number, (patterns, faces) in enumerate(self._apertures(f"{name}-shape", shape)):
                yield from patterns
                yield _material(patterns[-1].split()[2], "illum", f"{name}-{number}", _grey(radiance), ["void"])
                yield from (_polygon(f"{name}-{number}", f"{name}-{number}-{i}", face) for i, face in enumerate(faces))
        else:
            yield _material("void", "glow", name, [*_grey(radiance), 0])
            yield from self._body(name, f"{name}-body", shape)

    def _apertures(self, name: str, shape: Shape) -> Iterator[tuple[list[str], list[np.ndarray]]]:
        """Patterns, the last of which says where an aperture shines, and the aperture's faces (4, 3)."""
        match shape:
            case Disk():
                axes = np.stack([*geometry.tangents(shape.normal), geometry.unit(shape.normal)])
                corners = np.array(shape.center) + shape.radius * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) @ axes[:2]
                yield [self._pattern(name, "on_disk", [*shape.center, shape.radius])], [corners]
            case Sphere():
                size = (1 + ROOM) * shape.radius
                yield [self._pattern(name, "on_sphere", [*shape.center, shape.radius])], box(shape.center, size * np.eye(3))
            case Cylinder():
                axis = geometry.unit(shape.axis)
                halves = np.diag([shape.radius, shape.radius, shape.height / 2]) @ np.stack([*geometry.tangents(axis), axis])
                patterns = [self._pattern(name, "on_tube", [*shape.base, *axis, shape.height, shape.radius])]
                yield patterns, box(np.add(shape.base, halves[2]), (1 + ROOM) * halves)
            case Polygon():
                for number, corners in enumerate(convex_parts(np.array(shape.vertices))):
                    yield self._edges(f"{name}-{number}", corners, shape.normal), [frame(corners, shape.normal)]

    def _edges(self, name: str, corners: np.ndarray, normal: np.ndarray) -> list[str]:
        """Patterns one on the other, a half-plane each, whose product is a convex polygon."""
        patterns, before = [], "void"
        for number, (a, b) in enumerate(zip(corners, np.roll(corners, -1, axis=0), strict=True)):
            patterns.append(self._pattern(f"{name}-{number}", "left", [*a, *geometry.unit(np.cross(normal, b - a))], before))
            before = f"{name}-{number}"
        return patterns

    def _body(self, material: str, name: str, shape: Shape, inside: bool = False, behind: float = 0.0) -> Iterator[str]:
        """The shape itself; a flat one may be moved back by the part `behind` of its size."""
        match shape:
            case Polygon():
                corners = np.array(shape.vertices)
                yield _polygon(material, name, corners - behind * np.ptp(corners, axis=0).max() * shape.normal)
            case Disk():
                centre = np.array(shape.center) - behind * shape.radius * geometry.unit(shape.normal)
                yield _primitive(material, "ring", name, [*centre, *shape.normal, 0, shape.radius])
            case Sphere():
                yield _primitive(material, "bubble" if inside else "sphere", name, [*shape.center, shape.radius])
            case Cylinder():
                top = np.add(shape.base, shape.height * geometry.unit(shape.axis))
                yield _primitive(material, "tube" if inside else "cylinder", name, [*shape.base, *top, shape.radius])
            case Cap():
                numbers = [*shape.center, *geometry.unit(shape.axis), shape.radius * np.cos(np.radians(shape.half_angle))]
                yield f"void mixfunc {name}-cap\n4 {material} void on_cap {self.shapes}\n0\n{_numbers(numbers)}"
                yield _primitive(f"{name}-cap", "bubble" if inside else "sphere", name, [*shape.center, shape.radius])

    def _pattern(self, name: str, function: str, numbers: Any = (), modifier: str = "void") -> str:
        return f"{modifier} brightfunc {name}\n2 {function} {self.shapes}\n0\n{_numbers(numbers)}"


def box(centre: Any, halves: np.ndarray) -> list[np.ndarray]:
    """The six outward faces (4, 3) of a box; `halves` (3, 3) are its half axes, right-handed."""
    around = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    return [np.array(centre) + s * halves[i] + np.array([[-1, -s], [1, -s], [1, s], [-1, s]]) @ halves[[j, k]]
            for i, j, k in around for s in (1, -1)]


def frame(corners: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """The smallest rectangle (4, 3) around a convex polygon that has a side along one of its edges; it faces along `normal`."""
    def along(edge: np.ndarray) -> tuple[float, np.ndarray]:
        axes = np.stack([geometry.unit(edge), np.cross(normal, geometry.unit(edge))])
        flat = (corners - corners[0]) @ axes.T
        (a, b), (c, d) = flat.min(axis=0), flat.max(axis=0)
        return (c - a) * (d - b), corners[0] + np.array([[a, b], [c, b], [c, d], [a, d]]) @ axes

    return min((along(edge) for edge in np.roll(corners, -1, axis=0) - corners), key=lambda found: found[0])[1]


def convex_parts(corners: np.ndarray) -> list[np.ndarray]:
    """A polygon (n, 3) itself where it is convex, else its triangles."""
    edges = np.roll(corners, -1, axis=0) - corners
    turns = np.cross(edges, np.roll(edges, -1, axis=0)) @ geometry.vector_area(corners)
    return [corners] if (turns >= 0).all() else list(corners[mesh.tessellate(Polygon(tuple(map(tuple, corners)))).triangles])


def _polygon(material: str, name: str, corners: np.ndarray) -> str:
    return _primitive(material, "polygon", name, corners.ravel())


def _primitive(material: str, kind: str, name: str, numbers: Any) -> str:
    return f"{material} {kind} {name}\n0\n0\n{_numbers(numbers)}"


def _material(modifier: str, kind: str, name: str, numbers: Any, words: Any = ()) -> str:
    return f"{modifier} {kind} {name}\n{' '.join([str(len(words)), *words])}\n0\n{_numbers(numbers)}"


def _grey(value: float) -> list[float]:
    return [value] * 3


def _numbers(values: Any) -> str:
    return " ".join([str(len(values)), *(f"{value:.17g}" for value in values)])
