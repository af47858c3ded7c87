"""Round things that a pixel does not see: what is proven to be beside or behind all that it looks at."""

from __future__ import annotations

from collections.abc import Iterable

from lightproof import geometry
from lightproof.certify import planes
from lightproof.certify.balls import CannotCertify, Point, Rational, dot, exact, plus, point
from lightproof.certify.camera import Camera
from lightproof.certify.planes import Plane, Region
from lightproof.scene import AreaLight, Surface


def check_round(solids: Iterable[AreaLight | Surface], camera: Camera, pixel: Region) -> None:
    """Raises CannotCertify where a pixel may see anything round."""
    for item in solids:
        if not isinstance(item.shape, geometry.Polygon) and not _is_outside(item.shape, camera, pixel):
            raise CannotCertify(f"a pixel may see the {type(item.shape).__name__.lower()} '{item.id}'; a camera is covered where"
                                " it sees polygons alone, or one sphere alone")


def _is_outside(shape: geometry.Shape, camera: Camera, pixel: Region) -> bool:
    """Whether one of the planes around all that a pixel sees has a ball about the shape on its outer side."""
    centre, squared = _ball(shape)
    inside = plus(*camera.ray(*planes.centre(pixel)))
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
