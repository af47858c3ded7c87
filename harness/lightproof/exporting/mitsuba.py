"""Mitsuba 3: an XML file that every variant loads, meshes as .ply and half a sky as .exr beside it.

Colours are given as rgb, which spectral variants take for light like D65, so that a grey light is as grey in their pictures.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lightproof import exporting, geometry
from lightproof.exporting import numbers
from lightproof.geometry import Cap, Cylinder, Disk, Polygon, Shape, Sphere
from lightproof.renderers import half_sky, mesh
from lightproof.renderers.mitsuba import FAR
from lightproof.renderers.mitsuba_configurations import caveat, integrator
from lightproof.renderers.views import View, pose
from lightproof.scene import AreaLight, DirectionalLight, Environment, Light, PointLight, Scene, Surface

KINDS = {bool: "boolean", int: "integer", float: "float", str: "string", tuple: "point"}
SAMPLES = 1024  # the film adds up in float32 and is off by 5e-5 after 4,096


def write(scene: Scene, path: Path) -> None:
    """See `exporting.Tool`."""
    exporting.refuse(scene, AreaLight | PointLight | DirectionalLight | Environment, "Mitsuba")
    view = exporting.view(scene)
    root = ET.Element("scene", version="3.0.0")
    ET.SubElement(root, "default", name="spp", value=str(SAMPLES))
    search = integrator(scene)
    _plugin(root, "integrator", search.pop("type"), **search)
    _camera(root, view)
    if view.receiver:
        _content(_rectangle(root, view.receiver.corners), view.receiver.reflectance, 0)
    for light in scene.lights:
        _light(root, light, path)
    _surfaces(root, scene.surfaces, path)
    ET.indent(root)
    path.write_text("\n".join([*_head(scene, path), ET.tostring(root, "unicode"), ""]), encoding="utf-8")


def _head(scene: Scene, path: Path) -> list[str]:
    """As a processing instruction: a comment of XML may hold no double hyphen, and options have them."""
    lines = [*exporting.remarks(scene, path), f"Render: mitsuba -m scalar_rgb -o {path.stem}.exr {path.name}",
             f"Sums in float32 lose digits beyond {SAMPLES} samples: for less noise, average pictures of different seeds.",
             *filter(None, [caveat(scene, integrator(scene))])]
    return ['<?xml version="1.0" encoding="utf-8"?>', "<?lightproof", *(line.replace("?>", "? >") for line in lines), "?>"]


def _plugin(parent: ET.Element, tag: str, kind: str, **values: Any) -> ET.Element:
    element = ET.SubElement(parent, tag, type=kind)
    for name, value in values.items():
        text = numbers(value) if isinstance(value, tuple) else str(value).lower() if isinstance(value, bool) else str(value)
        ET.SubElement(element, KINDS[type(value)], name=name, value=text)
    return element


def _rgb(element: ET.Element, name: str, value: float) -> None:
    ET.SubElement(element, "rgb", name=name, value=numbers(value))


def _placed(element: ET.Element, matrix: np.ndarray) -> ET.Element:
    ET.SubElement(ET.SubElement(element, "transform", name="to_world"), "matrix", value=numbers(matrix))
    return element


def _camera(root: ET.Element, view: View) -> None:
    (columns, rows), (width, height) = view.resolution, view.half
    camera = _plugin(root, "sensor", view.projection, near_clip=view.near, far_clip=max(FAR, 1e3 * view.near))
    place = ET.SubElement(camera, "transform", name="to_world")
    if view.projection == "perspective":
        ET.SubElement(camera, "float", name="fov", value=repr(2 * float(np.degrees(np.arctan(width)))))
        ET.SubElement(camera, "string", name="fov_axis", value="x")
    else:
        ET.SubElement(place, "scale", value=numbers([width, height * columns / rows, 1]))
    ET.SubElement(place, "lookat", origin=numbers(view.origin), target=numbers(view.target), up=numbers(view.up))
    ET.SubElement(_plugin(camera, "sampler", "multijitter"), "integer", name="sample_count", value="$spp")
    film = _plugin(camera, "film", "hdrfilm", width=columns, height=rows, pixel_format="luminance", component_format="float32")
    _plugin(film, "rfilter", "box")


def _light(root: ET.Element, light: Light, path: Path) -> None:
    match light:
        case AreaLight():
            _content(_shape(root, light.shape, False, path, light.id), 0, light.radiance)
        case PointLight():
            _rgb(_plugin(root, "emitter", "point", position=light.position), "intensity", light.intensity)
        case DirectionalLight():
            beam = _plugin(root, "emitter", "directional")
            ET.SubElement(beam, "vector", name="direction", value=numbers(light.direction))
            _rgb(beam, "irradiance", light.irradiance)
        case Environment(extent="sphere"):
            _rgb(_plugin(root, "emitter", "constant"), "radiance", light.radiance)
        case Environment():
            _half_sky(root, light, exporting.companion(path, f"{light.id}.exr"))


def _half_sky(root: ET.Element, light: Environment, path: Path) -> None:
    write_grey(half_sky.picture(light.radiance), path)
    upright = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    _placed(_plugin(root, "emitter", "envmap", filename=path.name), upright)


def _surfaces(root: ET.Element, surfaces: Sequence[Surface], path: Path) -> None:
    """Those that are meshes and do not shine are one mesh for each reflectance: if they were several, Mitsuba 3.9 would join
    them while it loads the file, and forget their bounds."""
    dull = [surface for surface in surfaces if isinstance(surface.shape, Polygon | Cap) and not surface.radiance]
    for number, reflectance in enumerate(dict.fromkeys(surface.reflectance for surface in dull), 1):
        alike = [mesh.tessellate(each.shape, each.side == "inside") for each in dull if each.reflectance == reflectance]
        _content(_mesh(root, joined(alike), path, f"surfaces-{number}"), reflectance, 0)
    for surface in surfaces:
        if surface not in dull:
            shape = _shape(root, surface.shape, surface.side == "inside", path, surface.id)
            _content(shape, surface.reflectance, surface.radiance)


def joined(meshes: Sequence[mesh.Mesh]) -> mesh.Mesh:
    """Several meshes as one."""
    starts = np.cumsum([0, *(len(each.vertices) for each in meshes)])
    triangles = [each.triangles + start for each, start in zip(meshes, starts[:-1], strict=True)]
    return mesh.Mesh(np.vstack([each.vertices for each in meshes]), np.vstack(triangles))


def _content(shape: ET.Element, reflectance: float, radiance: float) -> None:
    _rgb(_plugin(shape, "bsdf", "diffuse"), "reflectance", reflectance)
    if radiance:
        _rgb(_plugin(shape, "emitter", "area"), "radiance", radiance)


def _shape(root: ET.Element, shape: Shape, inside: bool, path: Path, name: str) -> ET.Element:
    """A shape of Mitsuba's own, or a mesh in a file of its own."""
    match shape:
        case Sphere():
            return _plugin(root, "shape", "sphere", center=shape.center, radius=shape.radius, flip_normals=inside)
        case Cylinder():
            top = tuple(np.add(shape.base, shape.height * geometry.unit(shape.axis)))
            return _plugin(root, "shape", "cylinder", p0=shape.base, p1=top, radius=shape.radius, flip_normals=inside)
        case Disk():
            t, b = geometry.tangents(shape.normal)
            across = pose(shape.center, shape.radius * t, shape.radius * b, geometry.unit(shape.normal))
            return _placed(_plugin(root, "shape", "disk"), across)
        case Polygon() if mesh.is_rectangle(np.array(shape.vertices)):
            return _rectangle(root, np.array(shape.vertices))
        case Polygon() | Cap():
            return _mesh(root, mesh.tessellate(shape, inside), path, name)


def _mesh(root: ET.Element, shape: mesh.Mesh, path: Path, name: str) -> ET.Element:
    companion = exporting.companion(path, f"{name}.ply")
    write_ply(shape, companion)
    return _plugin(root, "shape", "ply", filename=companion.name, face_normals=True)


def _rectangle(root: ET.Element, corners: np.ndarray) -> ET.Element:
    a, b, _, d = corners
    x, y = (b - a) / 2, (d - a) / 2
    return _placed(_plugin(root, "shape", "rectangle"), pose(corners.mean(axis=0), x, y, geometry.unit(np.cross(x, y))))


def write_ply(shape: mesh.Mesh, path: Path) -> None:
    """Triangles as a text .ply file."""
    head = ["ply", "format ascii 1.0", f"element vertex {len(shape.vertices)}", *(f"property float {axis}" for axis in "xyz"),
            f"element face {len(shape.triangles)}", "property list uchar int vertex_indices", "end_header"]
    vertices, faces = map(numbers, shape.vertices), (f"3 {a} {b} {c}" for a, b, c in shape.triangles)
    path.write_text("\n".join([*head, *vertices, *faces, ""]), encoding="ascii")


def write_grey(image: np.ndarray, path: Path) -> None:
    """An image (rows, columns) as R, G and B of an OpenEXR file."""
    import OpenEXR

    OpenEXR.File({"type": OpenEXR.scanlineimage}, {"RGB": np.repeat(image[..., None], 3, axis=2)}).write(str(path))
