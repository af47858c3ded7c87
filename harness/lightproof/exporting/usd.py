"""USD: one .usda file with lights of UsdLux, camera, materials and render settings.

Units, by UsdLux: the intensity of a light that is not normalised is its radiance (written in nits for 1:1), that of a
distant light of no angle its irradiance. There are no point lights, so one is a sphere far smaller than any distance.
Materials are MaterialX's Lambert, with UsdPreviewSurface, which is none at grazing angles, for renderers without MaterialX.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from lightproof import exporting, geometry
from lightproof.exporting import CannotExport
from lightproof.geometry import Cylinder, Disk, Polygon, Shape, Sphere
from lightproof.renderers import mesh
from lightproof.renderers.views import View, pose
from lightproof.scene import AreaLight, DirectionalLight, Environment, Light, PointLight, Scene, Surface

TENTHS = 10  # per metre: the unit of a camera's lens and film
FOCAL = 50.0  # tenths of a metre; any length does, because the aperture is given to fit
FAR = 1e6  # m
POINT = 1e-3  # m, radius of the sphere that stands for a point light
STAGE = """(
    defaultPrim = "scene"
    metersPerUnit = 1
    renderSettingsPrimPath = "/render"
    upAxis = "Z"
)"""
CAVEAT = ("UsdLux leaves to the renderer whether lamps are seen and block, and USD whether a surface reflects on its back;"
          " Lightproof's lamps are seen and block, and its surfaces are black behind. Render without clamping or denoising.")


def write(scene: Scene, path: Path) -> None:
    """See `exporting.Tool`."""
    exporting.refuse(scene, AreaLight | PointLight | DirectionalLight | Environment, "USD")
    view = exporting.view(scene)
    about = [f"# {line}" for line in (*exporting.remarks(scene, path), CAVEAT)]
    things = [_camera(view), *map(_light, scene.lights), *map(_surface, scene.surfaces)]
    if view.receiver:
        receiver = mesh.Mesh(view.receiver.corners, np.array([[0, 1, 2], [0, 2, 3]]))
        things.append(_mesh("film_receiver", receiver, view.receiver.reflectance))
    lines = ["#usda 1.0", *about, STAGE, *_prim("Xform", "scene", {}, *things), *_settings(view, path.stem)]
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")


def _prim(kind: str, name: str, values: Mapping[str, object], *children: list[str], api: str = "") -> list[str]:
    """A prim as indented lines; the keys of `values` are types and names."""
    applied = f' (\n    prepend apiSchemas = [{api}]\n)' if api else ""
    content = [*(f"{key} = {value}" for key, value in values.items()), *(line for child in children for line in child)]
    return [*f'def {kind} "{name}"{applied}'.split("\n"), "{", *(f"    {line}" for line in content), "}"]


def _settings(view: View, name: str) -> list[str]:
    columns, rows = view.resolution
    aspect = (view.half[0] / columns) / (view.half[1] / rows)
    colour = {"uniform token dataType": '"color3f"', "uniform string sourceName": '"C.*"', "uniform token sourceType": '"lpe"'}
    file = {"token productName": f'"{name}.exr"', "rel orderedVars": "</render/product/colour>"}
    film = {"rel camera": "</scene/film_camera>", "rel products": "</render/product>",
            "uniform int2 resolution": f"({columns}, {rows})", "uniform float pixelAspectRatio": f"{aspect:.9g}",
            "uniform token aspectRatioConformPolicy": '"adjustPixelAspectRatio"'}
    product = _prim("RenderProduct", "product", file, _prim("RenderVar", "colour", colour))
    return _prim("RenderSettings", "render", film, product)


def _camera(view: View) -> list[str]:
    width, height = (2 * half * (FOCAL if view.projection == "perspective" else TENTHS) for half in view.half)
    right, up, forward = geometry.camera_frame(view.origin, view.target, view.up)
    lens = {"token projection": f'"{view.projection}"', "float focalLength": FOCAL, "float horizontalAperture": f"{width:.9g}",
            "float verticalAperture": f"{height:.9g}", "float2 clippingRange": f"({view.near:.9g}, {FAR:.9g})"}
    return _prim("Camera", "film_camera", lens | _at(pose(view.origin, right, up, -forward)))


def _at(matrix: np.ndarray) -> dict[str, str]:
    """A transform; USD's vectors are rows."""
    return {"matrix4d xformOp:transform": f"({', '.join(map(_tuple, matrix.T))})",
            "uniform token[] xformOpOrder": '["xformOp:transform"]'}


def _tuple(values: np.ndarray) -> str:
    return f"({', '.join(repr(float(value)) for value in values)})"


def _light(light: Light) -> list[str]:
    name = _name(light.id)
    match light:
        case AreaLight():
            return _area(name, light.shape, light.radiance)
        case PointLight():
            return _lamp("SphereLight", name, light.intensity / (np.pi * POINT**2), _here(light.position), radius=POINT)
        case DirectionalLight():
            place = _beaming((0, 0, 0), light.direction)
            return _lamp("DistantLight", name, light.irradiance, place, angle=0.0, normalize=True)
        case Environment(extent="sphere"):
            return _lamp("DomeLight", name, light.radiance, np.eye(4))
        case _:
            raise CannotExport(f"light '{light.id}': USD has no half a sky without an image of it")


def _area(name: str, shape: Shape, radiance: float) -> list[str]:
    match shape:
        case Sphere():
            return _lamp("SphereLight", name, radiance, _here(shape.center), radius=shape.radius)
        case Disk():
            return _lamp("DiskLight", name, radiance, _beaming(shape.center, shape.normal), radius=shape.radius)
        case Cylinder():
            axis = geometry.unit(shape.axis)
            place = pose(np.add(shape.base, shape.height / 2 * axis), axis, *geometry.tangents(axis))
            return _lamp("CylinderLight", name, radiance, place, length=shape.height, radius=shape.radius)
        case Polygon() if mesh.is_rectangle(np.array(shape.vertices)):
            a, b, c, d = np.array(shape.vertices)
            x = geometry.unit(b - a)
            place = pose((a + c) / 2, x, np.cross(-shape.normal, x), -shape.normal)
            size = {"width": float(np.linalg.norm(b - a)), "height": float(np.linalg.norm(d - a))}
            return _lamp("RectLight", name, radiance, place, **size)
        case _:
            return _mesh(name, mesh.tessellate(shape), 0, radiance)


def _lamp(kind: str, name: str, intensity: float, place: np.ndarray, normalize: bool = False, **size: float) -> list[str]:
    values = {"float inputs:intensity": f"{intensity:.9g}", "bool inputs:normalize": str(normalize).lower()}
    values |= {f"float inputs:{key}": f"{value:.9g}" for key, value in size.items()}
    return _prim(kind, name, values | _at(place))


def _here(position: geometry.Vec3) -> np.ndarray:
    return pose(position, *np.eye(3))


def _beaming(centre: geometry.Vec3, direction: geometry.Vec3) -> np.ndarray:
    """A lamp's place; it shines along its own negative z."""
    t, b = geometry.tangents(direction)
    return pose(centre, b, t, -geometry.unit(direction))


def _surface(surface: Surface) -> list[str]:
    shape = mesh.tessellate(surface.shape, surface.side == "inside")
    return _mesh(_name(surface.id), shape, surface.reflectance, surface.radiance)


def _mesh(name: str, shape: mesh.Mesh, reflectance: float, radiance: float = 0.0) -> list[str]:
    """Triangles with a material of their own; a mesh that shines has its light beside its material's reflection."""
    extent = f"[{_tuple(shape.vertices.min(axis=0))}, {_tuple(shape.vertices.max(axis=0))}]"
    values: dict[str, object] = {
        "point3f[] points": f"[{', '.join(map(_tuple, shape.vertices))}]", "float3[] extent": extent,
        "int[] faceVertexCounts": [3] * len(shape.triangles), "int[] faceVertexIndices": shape.triangles.ravel().tolist(),
        "uniform token subdivisionScheme": '"none"', "rel material:binding": f"</scene/{name}/material>",
    }
    if radiance:
        values |= {"float inputs:intensity": f"{radiance:.9g}", "uniform token light:materialSyncMode": '"independent"'}
    api = '"MaterialBindingAPI", "MeshLightAPI"' if radiance else '"MaterialBindingAPI"'
    return _prim("Mesh", name, values, _material(name, reflectance), api=api)


def _material(name: str, reflectance: float) -> list[str]:
    grey, here = f"({reflectance:.9g}, {reflectance:.9g}, {reflectance:.9g})", f"/scene/{name}/material"
    preview = {"uniform token info:id": '"UsdPreviewSurface"', "color3f inputs:diffuseColor": grey, "float inputs:roughness": 1,
               "int inputs:useSpecularWorkflow": 1, "color3f inputs:specularColor": "(0, 0, 0)"}
    diffuse = {"uniform token info:id": '"ND_oren_nayar_diffuse_bsdf"', "color3f inputs:color": grey,
               "float inputs:roughness": 0}
    lambert = {"uniform token info:id": '"ND_surface"', "token inputs:bsdf.connect": f"<{here}/diffuse.outputs:out>"}
    outputs = {"token outputs:surface.connect": f"<{here}/preview.outputs:surface>",
               "token outputs:mtlx:surface.connect": f"<{here}/lambert.outputs:out>"}
    shaders = [_shader("preview", preview, "surface"), _shader("diffuse", diffuse, "out"), _shader("lambert", lambert, "out")]
    return _prim("Material", "material", outputs, *shaders)


def _shader(name: str, values: Mapping[str, object], output: str) -> list[str]:
    *head, end = _prim("Shader", name, values)
    return [*head, f"    token outputs:{output}", end]


def _name(identifier: str) -> str:
    """A prim's name: letters, digits and underscores, no digit first."""
    return f"_{identifier}".replace("-", "_") if identifier[0].isdigit() else identifier.replace("-", "_")
