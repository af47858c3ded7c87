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
from lightproof.renderers import radiance_apertures
from lightproof.renderers.radiance_transport import Transport, is_lamp
from lightproof.scene import (
    AreaLight,
    CameraFilm,
    DirectionalLight,
    Environment,
    Light,
    OvercastSky,
    PointLight,
    Scene,
    SunDisc,
    Surface,
)

BEAM = 0.01  # degrees across of the distant disc that stands for a beam
BULB = 1e-5  # radius of the ball that stands for a point, of the scene's extent
FAR = 100  # of the scene's extent: half the width of a sun's aperture, so far away that the sun all but fills it
APART = 1e-5  # of their size: how far things lie apart that share a place; but no less than Radiance tells apart
LEAST = 4e-6  # m

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
{ triangle: A1..A4, A5..A8, A9..A12 the half-space on the inner side of each edge }
on_triangle = if(A1*Px + A2*Py + A3*Pz - A4,
  if(A5*Px + A6*Py + A7*Pz - A8, if(A9*Px + A10*Py + arg(11)*Pz - arg(12), 1, 0), 0), 0);
{ polygon: A1..A3 and A4..A6 axes in its plane, A7 number of edges, then its corners along these axes, the first one again
  at the end; a point is inside where a line to one side crosses an odd number of edges }
pu = Px*A1 + Py*A2 + Pz*A3;
pv = Px*A4 + Py*A5 + Pz*A6;
cu(i) = arg(6 + 2*i);
cv(i) = arg(7 + 2*i);
rise(i) = (pv - cv(i)) * (cu(i+1) - cu(i)) / (cv(i+1) - cv(i));
cross(i) = if((pv - cv(i)) * (cv(i+1) - pv), if(cu(i) + rise(i) - pu, -1, 1), 1);
crosses(n) = if(n - 0.5, cross(n) * crosses(n - 1), 1);
on_polygon = (1 - crosses(A7)) / 2;
{ cap: A1..A3 centre, A4..A6 unit axis, A7 radius times cosine of the half angle }
on_cap = if(wa - A7, 1, 0);
{ sun: A1..A3 unit direction to it, A4 cosine of its half angle }
on_sun = if(Dx*A1 + Dy*A2 + Dz*A3 - A4, 1, 0);
{ front of a surface; the sky of the CIE }
front = if(Rdot, 1, 0);
overcast = (1 + 2*Dz) / 3;
"""


def describe(scene: Scene, transport: Transport, shapes: str) -> str:
    """The scene's text; `shapes` names the file that holds SHAPES."""
    writer = Writer(scene, transport, *radiance_apertures.whole(scene), shapes)
    parts = [part for light in scene.lights for part in writer.light(light)]
    parts += [part for surface in scene.surfaces for part in writer.surface(surface)]
    return "\n".join(parts) + "\n"


@dataclass(frozen=True)
class Writer:
    """Radiance's words for lights and surfaces; each method gives the primitives of one."""

    scene: Scene
    transport: Transport
    centre: np.ndarray
    extent: float
    shapes: str

    def light(self, light: Light) -> Iterator[str]:
        """A light."""
        name = light.id
        match light:
            case AreaLight():
                yield from self._lamp(name, light.shape, light.radiance)
            case PointLight():
                radius, seen = BULB * self.extent, isinstance(self.scene.film, CameraFilm)
                kind, words = ("illum", ["void"]) if seen else ("light", [])
                yield _material("void", kind, name, _grey(light.intensity / (np.pi * radius**2)), words)
                yield _primitive(name, "sphere", f"{name}-bulb", [*light.position, radius])
            case DirectionalLight():
                solid_angle = 4 * np.pi * np.sin(np.radians(BEAM) / 4) ** 2
                yield _material("void", "light", name, _grey(light.irradiance / solid_angle))
                yield _primitive(name, "source", f"{name}-disc", [*np.negative(light.direction), BEAM])
            case Environment():
                yield _material("void", "glow", name, [*_grey(light.radiance), 0])
                yield _primitive(name, "source", f"{name}-dome", [0, 0, 1, 360 if light.extent == "sphere" else 180])
            case SunDisc():
                yield from self._sun(light)
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

    def _sun(self, sun: SunDisc) -> Iterator[str]:
        """A disc to be seen, and an aperture far away that shines in the directions of the disc."""
        toward, spread = geometry.unit(np.negative(sun.direction)), np.tan(np.radians(sun.half_angle))
        yield _material("void", "glow", f"{sun.id}-glow", [*_grey(sun.radiance), -1])
        yield _primitive(f"{sun.id}-glow", "source", f"{sun.id}-disc", [*toward, 2 * sun.half_angle])
        yield self._pattern(f"{sun.id}-shape", "on_sun", [*toward, np.cos(np.radians(sun.half_angle))])
        yield _material(f"{sun.id}-shape", "illum", sun.id, _grey(sun.radiance), ["void"])
        sides = (FAR + 1) * self.extent * np.stack(geometry.tangents(sun.direction))
        face = FAR / spread * self.extent * toward + np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) @ sides
        yield _polygon(sun.id, f"{sun.id}-face", self.centre + face)

    def _lamp(self, name: str, shape: Shape, radiance: float) -> Iterator[str]:
        if self.transport.aims_at(shape):
            yield _material("void", "light", name, _grey(radiance))
            yield from self._body(name, f"{name}-face", shape)
        elif self.transport.aperture:
            yield _material("void", "glow", f"{name}-glow", [*_grey(radiance), -1])
            yield from self._body(f"{name}-glow", f"{name}-body", shape, behind=1)
            function, numbers, faces = self._aperture(shape)
            yield self._pattern(f"{name}-shape", function, numbers)
            yield _material(f"{name}-shape", "illum", name, _grey(radiance), ["void"])
            yield from (_polygon(name, f"{name}-{number}", face) for number, face in enumerate(faces))
        else:
            yield _material("void", "glow", name, [*_grey(radiance), 0])
            yield from self._body(name, f"{name}-body", shape)

    def _aperture(self, shape: Shape) -> tuple[str, list[float], list[np.ndarray]]:
        """The function of SHAPES that says where an aperture shines, its numbers, and the aperture's faces (4, 3)."""
        match shape:
            case Polygon() if len(shape.vertices) == 3:
                return "on_triangle", radiance_apertures.sides(shape), [radiance_apertures.frame(shape)]
            case Polygon():
                return "on_polygon", radiance_apertures.outline(shape), [radiance_apertures.frame(shape)]
            case Disk():
                sides = shape.radius * np.stack(geometry.tangents(shape.normal))
                face = np.array(shape.center) + np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) @ sides
                return "on_disk", [*shape.center, shape.radius], [face]
            case Sphere():
                return "on_sphere", [*shape.center, shape.radius], radiance_apertures.box(shape)
            case Cylinder():
                numbers = [*shape.base, *geometry.unit(shape.axis), shape.height, shape.radius]
                return "on_tube", numbers, radiance_apertures.box(shape)

    def _body(self, material: str, name: str, shape: Shape, inside: bool = False, behind: int = 0) -> Iterator[str]:
        """The shape itself; a flat one may be moved back by gaps."""
        match shape:
            case Polygon():
                yield _polygon(material, name, np.array(shape.vertices) - behind * _gap(shape) * shape.normal)
            case Disk():
                centre = np.array(shape.center) - behind * _gap(shape) * geometry.unit(shape.normal)
                yield _primitive(material, "ring", name, [*centre, *shape.normal, 0, shape.radius])
            case Sphere():
                yield _primitive(material, "bubble" if inside else "sphere", name, [*shape.center, shape.radius])
            case Cylinder():
                top = np.add(shape.base, shape.height * geometry.unit(shape.axis))
                yield _primitive(material, "tube" if inside else "cylinder", name, [*shape.base, *top, shape.radius])
            case Cap():
                numbers = [*shape.center, *geometry.unit(shape.axis), shape.radius * np.cos(np.radians(shape.half_angle))]
                yield f"void mixfunc {name}-cap\n4 {material} void on_cap {self.shapes}\n0\n{_numbers(numbers)}"
                radius = shape.radius + self._before(shape) * _gap(shape)
                yield _primitive(f"{name}-cap", "bubble" if inside else "sphere", name, [*shape.center, radius])

    def _before(self, cap: Cap) -> int:
        """How many caps of the same sphere come before this one: of two spheres in one place a ray meets but one."""
        shapes = [getattr(item, "shape", None) for item in (*self.scene.lights, *self.scene.surfaces)]
        before = shapes[: next(place for place, shape in enumerate(shapes) if shape is cap)]
        return sum(isinstance(shape, Cap) and (shape.center, shape.radius) == (cap.center, cap.radius) for shape in before)

    def _pattern(self, name: str, function: str, numbers: Any = ()) -> str:
        return f"void brightfunc {name}\n2 {function} {self.shapes}\n0\n{_numbers(numbers)}"


def _gap(shape: Polygon | Disk | Cap) -> float:
    size = np.ptp(shape.vertices, axis=0).max() if isinstance(shape, Polygon) else shape.radius
    return max(APART * float(size), LEAST)


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
