"""What a camera sees of polygons: lamps, what reflects their light once, what only hides, and the sky beyond.

Straight edges stay straight in a picture, and so does the line in which a plane of `Field.events` meets a surface. So a pixel
is cut in exact numbers along the outlines of all that may be seen, the ray through the middle of each part finds what it
shows, and over the part of a surface that reflects `direct` integrates irradiance as over a cell of a film: L = rho E / pi.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import combinations

from flint import arb, fmpq

from lightproof import geometry, scene
from lightproof.certify import direct, faces, planes, provenance, skies_seen
from lightproof.certify.balls import CannotCertify, Element, Number, Point, Rational, dot, exact, plus, point
from lightproof.certify.camera import Camera
from lightproof.certify.faces import Face
from lightproof.certify.planes import Plane, Region
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
    camera = Camera.of(scene_.film)
    _check_reflections(scene_)
    polygons = _polygons(scene_, camera)
    lines = sorted(faces.lines(polygons, camera) | skies_seen.lines(camera))
    error = _brightest(scene_, polygons) * camera.blur
    fields = cache(lambda plane: direct.fields(scene_, plane))

    def radiance(region: Region) -> Number:
        face = faces.nearest(polygons, camera, planes.centre(region))
        if face is None:
            return skies_seen.radiance(scene_.lights, camera, region)
        if not _in_front(face, region):
            return fmpq(0)
        if not face.reflectance:
            return face.radiance
        return face.radiance + face.reflectance / arb.pi() * direct.mean_over(face.view, fields(face.plane), region)

    def parts(region: Region) -> list[tuple[Rational, Number]]:
        return [(planes.area(part), radiance(part)) for part in planes.cut(region, lines)]

    def element(index: int) -> arb:
        pixel = camera.pixel(index)
        _check_round(scene_, camera, pixel)
        shown = parts(pixel)
        if _level(shown) and _level([*shown, *parts(camera.wide(pixel))]):
            return arb(shown[0][1])
        total = sum((area * value for area, value in shown), arb(0))
        return total / planes.area(pixel) + arb(0, error.abs_upper())

    return element


def _level(shown: list[tuple[Rational, Number]]) -> bool:
    """Whether all parts show the same radiance, known without error."""
    values = [arb(value) for _, value in shown]
    return all(value.is_exact() and value == values[0] for value in values)


def _in_front(face: Face, region: Region) -> bool:
    start, _ = face.view.camera.ray(*planes.centre(region))
    return face.plane.height(start) > 0


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


def _check_round(scene_: Scene, camera: Camera, pixel: Region) -> None:
    """Raises CannotCertify where a pixel may see anything round."""
    for item in _solids(scene_):
        if not isinstance(item.shape, geometry.Polygon) and not _out_of_view(item.shape, camera, pixel):
            raise CannotCertify(f"a pixel may see the {type(item.shape).__name__.lower()} '{item.id}'; a camera is covered where"
                                " it sees polygons alone, or one sphere alone")


def _out_of_view(shape: geometry.Shape, camera: Camera, pixel: Region) -> bool:
    """Whether one of the planes around all that a pixel sees has a ball about the shape on its outer side."""
    centre, squared = _ball(shape)
    start, along = camera.ray(*planes.centre(pixel))
    inside = plus(start, along)
    for plane in _sides(camera, pixel):
        height = plane.height(centre)
        if height * plane.height(inside) < 0 and height * height >= squared * dot(plane.normal, plane.normal):
            return True
    return False


def _sides(camera: Camera, pixel: Region) -> list[Plane]:
    """Planes through the pixel's sides, and the camera's own."""
    rays = [(start, plus(start, along)) for start, along in (camera.ray(*corner) for corner in pixel)]
    return [camera.film, *(planes.through(*rays[i - 1], rays[i][1]) for i in range(len(rays)))]


def _ball(shape: geometry.Shape) -> tuple[Point, Rational]:
    """Centre and squared radius of a ball that holds a round shape."""
    if isinstance(shape, geometry.Cylinder):
        return point(shape.base), exact(shape.height) ** 2 + exact(shape.radius) ** 2
    return point(shape.center), exact(shape.radius) ** 2


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
