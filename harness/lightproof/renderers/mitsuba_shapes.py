"""Shapes as Mitsuba's plugins: analytic where it has the shape, triangles elsewhere."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from lightproof import geometry
from lightproof.geometry import Cap, Cylinder, Disk, Polygon, Shape, Sphere
from lightproof.renderers import mesh
from lightproof.renderers.views import pose


def build(mi: ModuleType, shape: Shape, content: dict[str, Any], inside: bool = False) -> Any:
    """A plugin's dictionary, or a mesh, with its `content` (bsdf and emitter) on the front."""
    round_ = {"radius": shape.radius, "flip_normals": inside, **content} if isinstance(shape, Sphere | Cylinder) else {}
    match shape:
        case Sphere():
            return {"type": "sphere", "center": list(shape.center), **round_}
        case Cylinder():
            top = np.add(shape.base, shape.height * geometry.unit(shape.axis))
            return {"type": "cylinder", "p0": list(shape.base), "p1": top.tolist(), **round_}
        case Disk():
            t, b = geometry.tangents(shape.normal)
            return {"type": "disk", "to_world": frame(mi, shape.center, shape.radius * t, shape.radius * b), **content}
        case Polygon() if mesh.is_rectangle(np.array(shape.vertices)):
            return rectangle(mi, np.array(shape.vertices), content)
        case Polygon() | Cap():
            return triangles(mi, mesh.tessellate(shape, inside), content)


def rectangle(mi: ModuleType, corners: np.ndarray, content: dict[str, Any]) -> dict[str, Any]:
    """The rectangle with `corners` (4, 3) [m], counter-clockwise seen from its front."""
    a, b, _, d = corners
    return {"type": "rectangle", "to_world": frame(mi, corners.mean(axis=0), (b - a) / 2, (d - a) / 2), **content}


def frame(mi: ModuleType, centre: Any, x: np.ndarray, y: np.ndarray) -> Any:
    """The transform that takes the first two axes to `x` and `y`, the third to their unit normal, the origin to `centre`."""
    return mi.ScalarTransform4f(pose(centre, x, y, geometry.unit(np.cross(x, y))))


def triangles(mi: ModuleType, shape: mesh.Mesh, content: dict[str, Any]) -> Any:
    """A mesh object; its parts are loaded first, because a mesh that is built by hand takes no dictionaries."""
    properties = mi.Properties()
    for name, part in content.items():
        properties[name] = mi.load_dict(part)
    built = mi.Mesh("triangles", len(shape.vertices), len(shape.triangles), props=properties)
    parameters = mi.traverse(built)
    parameters["vertex_positions"] = shape.vertices.astype(np.float32).ravel()
    parameters["faces"] = shape.triangles.astype(np.uint32).ravel()
    parameters.update()
    return built
