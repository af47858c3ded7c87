"""What triangles in the place of round shapes change of a film: computed from the geometry alone, and never measured."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from dataclasses import replace

import numpy as np

from lightproof import geometry
from lightproof.geometry import Cylinder, Polygon, Sphere
from lightproof.renderers import mesh
from lightproof.renderers.mesh import Mesh
from lightproof.renderers.ribbons import ROUND, Outlines
from lightproof.renderers.sight import hides
from lightproof.scene import AreaLight, CameraFilm, DirectionalLight, OvercastSky, PlaneFilm, PointLight, Scene, Surface

AFAR = 1e9  # m: where a beam comes from
DEEPEST = 2  # of an outline's width: the middles of triangles lie no deeper


def meshes(scene: Scene, native: Container[str] = (), lamp_corners: int = mesh.CIRCLE) -> dict[str, Mesh]:
    """The triangles of a scene's round shapes by id, but for those that are `native` to a renderer; a light's circle has
    `lamp_corners`."""
    return {thing.id: mesh.tessellate(thing.shape, getattr(thing, "side", "") == "inside",
                                      lamp_corners if isinstance(thing, AreaLight) else mesh.CIRCLE)
            for thing in _things(scene) if not isinstance(thing.shape, Polygon) and thing.id not in native}


def difference(scene: Scene, meshes: Mapping[str, Mesh]) -> np.ndarray | None:
    """Largest difference (n,) [unit of the film] that `meshes` make which stand for round shapes, by the ids of these; None where
    there are none, infinite where it is not known: after reflections, before a camera, where points and beams cast shadows on
    a plane, behind open tubes, too near a shape.

    A light on its own differs by the very light of the ribbon between its outline and that of its triangles. Where things
    hide each other, what is bounded is the light of the ribbons: none is brighter there than the brightest thing in the
    scene. Plane films are asked in the middle of each cell.
    """
    if not meshes:
        return None
    if _is_same_everywhere(scene):
        return np.zeros(scene.size)
    stand_ins = {thing: meshes[thing.id] for thing in _things(scene) if thing.id in meshes}
    if not _is_plain(scene) or not all(_is_outside(thing) for thing in stand_ins):
        return np.full(scene.size, np.inf)
    outlines = {thing: Outlines(thing.shape, triangles) for thing, triangles in stand_ins.items()}
    return np.array([_at(scene, outlines, point, normal) for point, normal in _receivers(scene)])


def _at(scene: Scene, outlines: Mapping[AreaLight | Surface, Outlines], point: np.ndarray, normal: np.ndarray) -> float:
    alone = len(scene.lights) + len(scene.surfaces) == 1
    brightest = max(_radiance(thing) for thing in (*scene.lights, *scene.surfaces))
    seen = brightest * sum(_projected(each, point, normal, alone) for each in outlines.values()) if brightest else 0.0
    casting = [light for light in scene.lights if isinstance(light, PointLight | DirectionalLight)]
    return seen + sum(_cast(light, list(outlines.values()), point, normal) for light in casting)


def _cast(light: PointLight | DirectionalLight, outlines: list[Outlines], point: np.ndarray, normal: np.ndarray) -> float:
    """Irradiance [W/m2] of a light without size, where a shape hides it that is as small as its triangles somewhere are, or as
    large, and not both; else 0."""
    if isinstance(light, PointLight):
        way = np.array(light.position) - point
        value = light.intensity / float(way @ way)
    else:
        way, value = -AFAR * geometry.unit(light.direction), light.irradiance
    differs = any(len({hides(shape, point, point + way) for shape in _extremes(each)}) > 1 for each in outlines)
    return value * max(0.0, float(geometry.unit(way) @ normal)) if differs else 0.0


def _extremes(outlines: Outlines) -> list[ROUND]:
    """The shape as small and as large as its triangles are anywhere."""
    shape, depth = outlines.shape, DEEPEST * outlines.width
    return [replace(shape, radius=radius) for radius in (shape.radius - depth, shape.radius + depth)]


def _projected(outlines: Outlines, point: np.ndarray, normal: np.ndarray, alone: bool) -> float:
    """Projected solid angle [sr] by which a shape and its triangles differ: of a light that is alone what they make in sum, else
    all that is not the same; infinite too near, and of an open tube that hides things, whose back is no part of its ribbon."""
    if alone and not outlines.faces(point):
        return 0.0
    ribbon = outlines.ribbon(point)
    if ribbon is None or (isinstance(outlines.shape, Cylinder) and not alone):
        return np.inf
    pieces = np.maximum(ribbon.directions @ normal, 0) * ribbon.solid_angles
    return float(abs(pieces.sum()) if alone else np.abs(pieces).sum())


def _things(scene: Scene) -> list[AreaLight | Surface]:
    return [thing for thing in (*scene.lights, *scene.surfaces) if hasattr(thing, "shape")]


def _is_plain(scene: Scene) -> bool:
    """Whether all light comes straight to a film that is lit by it, and casts soft shadows unless the film has no cells."""
    hard = isinstance(scene.film, PlaneFilm) and any(isinstance(light, PointLight | DirectionalLight) for light in scene.lights)
    return not (scene.reflects or hard or isinstance(scene.film, CameraFilm))


def _is_outside(thing: AreaLight | Surface) -> bool:
    return isinstance(thing.shape, ROUND) and getattr(thing, "side", "outside") == "outside"


def _is_same_everywhere(scene: Scene) -> bool:
    """Whether the film is in a closed wall that glows by itself: its radiance depends on no shape."""
    if scene.lights or len(scene.surfaces) != 1 or not isinstance(scene.surfaces[0].shape, Sphere):
        return False
    wall = scene.surfaces[0]
    places = [scene.film.origin] if isinstance(scene.film, CameraFilm) else [point for point, _ in _receivers(scene)]
    distances = np.linalg.norm(np.array(places) - wall.shape.center, axis=1)
    return wall.side == "inside" and bool((distances <= wall.shape.radius * (1 + mesh.RIGHT)).all())


def _radiance(thing: object) -> float:
    return thing.zenith_radiance if isinstance(thing, OvercastSky) else getattr(thing, "radiance", 0.0)


def _receivers(scene: Scene) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """The film's points, or the middles of its cells, each with its unit normal."""
    film = scene.film
    if not isinstance(film, PlaneFilm):
        yield from zip(np.array(film.positions), geometry.unit(np.array(film.normals)), strict=True)
        return
    columns, rows = film.resolution
    for row, column in np.ndindex(rows, columns):
        yield film.origin + (column + 0.5) / columns * np.array(film.u) + (row + 0.5) / rows * np.array(film.v), film.normal
