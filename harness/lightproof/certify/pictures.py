"""What a camera sees of polygons: lamps, what reflects their light once, what only hides, and the sky beyond.

Straight edges stay straight in a picture, and so does the line in which a plane of `Field.events` meets a surface. So a pixel
is cut in exact numbers along the outlines of all that may be seen, the ray through the middle of each part finds what it
shows, and over the part of a surface that reflects `direct` integrates irradiance as over a cell of a film: L = rho E / pi.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import combinations

from flint import arb, fmpq

from lightproof import geometry, scene
from lightproof.certify import direct, faces, planes, provenance, skies_seen, unseen
from lightproof.certify.balls import CannotCertify, Element, Number, Rational, dot, exact, point
from lightproof.certify.camera import Camera
from lightproof.certify.faces import Face
from lightproof.certify.field import Field
from lightproof.certify.planes import Line, Plane, Region
from lightproof.certify.provenance import Provenance
from lightproof.scene import AreaLight, CameraFilm, Scene, Surface


def covers(scene_: Scene) -> bool:
    """Whether the film is a camera."""
    return isinstance(scene_.film, CameraFilm)


def kind(scene_: Scene) -> str:
    """Areas are exact; irradiance is as `direct` knows it."""
    return direct.kind(scene_)


def provenance_of(scene_: Scene) -> Provenance:
    """That of the light on each surface that reflects, and of seeing it."""
    lit = [_before(surface, scene_) for surface in scene_.surfaces if surface.reflectance > 0 and scene_.reflects]
    return provenance.joined([*map(direct.provenance_of, lit), provenance.SEEN])


def _before(surface: Surface, scene_: Scene) -> Scene:
    """The scene with the surfaces alone that have a part in front of a surface."""
    return replace(scene_, surfaces=tuple(other for other in scene_.surfaces if not _behind(surface, other)))


def solve(scene_: Scene) -> Element:
    """Mean radiance of each pixel. Raises CannotCertify."""
    _check_reflections(scene_)
    camera = Camera.of(scene_.film)
    polygons = _polygons(scene_, camera)
    lines = sorted(faces.lines(polygons, camera) | skies_seen.lines(camera))
    error = arb(0, (_brightest(scene_, polygons) * camera.blur).abs_upper())
    return Picture(scene_, camera, polygons, lines, error, cache(partial(direct.fields, scene_))).pixel


@dataclass(frozen=True, eq=False)
class Picture:
    """What a camera may see: polygons, and the lines in which what it sees may change; `error` bounds what the stand-ins for
    pixels make wrong, and `fields` gives the irradiance on the front of a plane."""

    scene: Scene
    camera: Camera
    polygons: list[Face]
    lines: list[Line]
    error: arb
    fields: Callable[[Plane], list[Field]]

    def pixel(self, index: int) -> arb:
        """Mean radiance of a pixel; without error where all of it shows one that is known without. Raises CannotCertify."""
        region = self.camera.pixel(index)
        wide = self.camera.wide(region)
        unseen.check_round(_solids(self.scene), self.camera, wide)
        shown = self._parts(region)
        if _level(shown) and _level([*shown, *self._parts(wide)]):
            return arb(shown[0][1])
        return sum((area * value for area, value in shown), arb(0)) / planes.area(region) + self.error

    def _parts(self, region: Region) -> list[tuple[Rational, Number]]:
        """Area and mean radiance of the parts into which outlines cut a region."""
        return [(planes.area(part), self._radiance(part)) for part in planes.cut(region, self.lines)]

    def _radiance(self, region: Region) -> Number:
        """Mean radiance of a region that no outline crosses."""
        middle = planes.centre(region)
        face = faces.nearest(self.polygons, self.camera, middle)
        if face is None:
            return skies_seen.radiance(self.scene.lights, self.camera, region)
        if face.plane.height(self.camera.ray(*middle)[0]) < 0:
            return fmpq(0)
        if not face.reflectance:
            return face.radiance
        irradiance = direct.mean_over(face.view, self.fields(face.plane), region)
        return face.radiance + face.reflectance / arb.pi() * irradiance


def _level(shown: list[tuple[Rational, Number]]) -> bool:
    """Whether all parts show the same radiance, known without error."""
    values = [arb(value) for _, value in shown]
    return all(value.is_exact() and value == values[0] for value in values)


def _polygons(scene_: Scene, camera: Camera) -> list[Face]:
    """All polygons. Raises CannotCertify where the camera lies in one."""
    polygons = [Face.of(item, camera, _reflectance(item, scene_)) for item in _solids(scene_)
                if isinstance(item.shape, geometry.Polygon)]
    for face in polygons:
        face.check_apart(camera)
    return polygons


def _reflectance(item: AreaLight | Surface, scene_: Scene) -> float:
    return item.reflectance if isinstance(item, Surface) and scene_.max_bounces != 0 else 0.0


def _solids(scene_: Scene) -> list[AreaLight | Surface]:
    return [*(light for light in scene_.lights if isinstance(light, AreaLight)), *scene_.surfaces]


def _check_reflections(scene_: Scene) -> None:
    """Raises CannotCertify where light may be reflected more than once."""
    bright = [surface for surface in scene_.surfaces if surface.reflectance > 0 and scene_.max_bounces not in (0, 1)]
    for one, other in combinations(bright, 2):
        if not (_behind(one, other) or _behind(other, one)):
            raise CannotCertify(f"light may go from '{one.id}' to '{other.id}' and on; a camera is covered where it is reflected"
                                " once: with max_bounces = 1, or where no surface that reflects is in front of another")
    for surface in bright:
        if surface.side == "inside":
            raise CannotCertify(f"light may be reflected more than once inside '{surface.id}'")


def _behind(surface: Surface, other: Surface) -> bool:
    """Whether nothing of another surface is in front of a polygon."""
    if not isinstance(surface.shape, geometry.Polygon):
        return False
    return direct.lies_on(other.shape, planes.of([point(corner) for corner in surface.shape.vertices]))


def _brightest(scene_: Scene, polygons: list[Face]) -> Number:
    """No radiance in the picture is above this: a lamp or a sky of radiance L gives no surface more than pi L."""
    glow = sum((face.radiance for face in polygons), fmpq(0))
    return glow + sum((_strength(light, polygons) for light in scene_.lights), fmpq(0))


def _strength(light: scene.Light, polygons: list[Face]) -> Rational:
    """The most radiance that a light shows, or that a surface shows by its light."""
    if isinstance(light, scene.PointLight):
        planes_lit = (face.plane for face in polygons if face.reflectance)
        return sum((exact(light.intensity) / square for plane in planes_lit if (square := _distance(plane, light))), fmpq(0))
    named = {scene.DirectionalLight: "irradiance", scene.OvercastSky: "zenith_radiance"}
    return exact(getattr(light, named.get(type(light), "radiance")))


def _distance(plane: Plane, light: scene.PointLight) -> Rational:
    """The squared distance of a point light from a plane."""
    return plane.height(point(light.position)) ** 2 / dot(plane.normal, plane.normal)
