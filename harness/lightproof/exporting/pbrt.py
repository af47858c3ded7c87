"""pbrt-v4: one .pbrt file, meshes included.

Units, by pbrt's source (lights.cpp, film.cpp): a light's rgb is multiplied by the spectrum of the colour space's illuminant
and divided by that spectrum's luminance, and the film multiplies by its sensor's imaging ratio, exposure time x iso / 100.
With the sensor that is the default, "cie1931" at iso 100, one second and no white balance, a pixel is the light's rgb.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lightproof import exporting, geometry
from lightproof.exporting import numbers
from lightproof.geometry import Cap, Cylinder, Disk, Polygon, Shape, Sphere
from lightproof.renderers import mesh, transport
from lightproof.renderers.views import View, pose
from lightproof.scene import AreaLight, DirectionalLight, Environment, Light, PointLight, Scene, Surface

SAMPLES = 1024
UNITS = ("Units: radiance 1:1, as long as the sensor is the default: cie1931, iso 100, a shutter of 1 s, no white balance. With"
         " another, give grade the factor: --scale.")
TWO_SIDED = ("pbrt's diffuse surfaces reflect on both sides, and Lightproof's on the front only: where light reaches the back"
             " of one that reflects, pbrt is right to differ.")


def write(scene: Scene, path: Path) -> None:
    """See `exporting.Tool`."""
    exporting.refuse(scene, AreaLight | PointLight | DirectionalLight | Environment, "pbrt")
    view = exporting.view(scene)
    about = [*exporting.remarks(scene, path), f"Render: pbrt {path.name}", UNITS, *([TWO_SIDED] if scene.reflects else [])]
    receiver = view.receiver and _solid(_triangles(_flat(view.receiver.corners)), view.receiver.reflectance, 0)
    things = [*([receiver] if receiver else []), *map(_light, scene.lights), *map(_surface, scene.surfaces)]
    head = [*(f"# {line}" for line in about), *_camera(view, path.stem), *_integrator(scene), "WorldBegin"]
    path.write_text("\n".join([*head, *things, ""]), encoding="utf-8")


def _camera(view: View, name: str) -> list[str]:
    """pbrt is left-handed: its columns would run the other way. A tangent of 1 is 45 degrees, half of this field of view."""
    (width, height), (columns, rows) = view.half, view.resolution
    angle = ' "float fov" [90]' if view.projection == "perspective" else ""
    return [
        "Scale -1 1 1",
        f"LookAt {numbers(view.origin)}  {numbers(view.target)}  {numbers(view.up)}",
        f'Camera "{view.projection}" "float screenwindow" [{numbers([-width, width, -height, height])}]{angle}',
        f'Film "rgb" "integer xresolution" [{columns}] "integer yresolution" [{rows}] "bool savefp16" false'
        f' "string sensor" "cie1931" "float iso" [100] "string filename" "{name}.exr"',
        'PixelFilter "box" "float xradius" [0.5] "float yradius" [0.5]',
    ]


def _integrator(scene: Scene) -> list[str]:
    """`maxdepth` counts reflections, of the receiver too."""
    depth = transport.edges(scene) - 1
    return [f'Sampler "independent" "integer pixelsamples" [{SAMPLES}]', f'Integrator "path" "integer maxdepth" [{depth}]']


def _light(light: Light) -> str:
    match light:
        case AreaLight():
            return _solid(_shape(light.shape), 0, light.radiance)
        case PointLight():
            return f'LightSource "point" {_rgb("I", light.intensity)} "point3 from" [{numbers(light.position)}]'
        case DirectionalLight():
            back = -geometry.unit(light.direction)
            return f'LightSource "distant" {_rgb("L", light.irradiance)} "point3 from" [{numbers(back)}] "point3 to" [0 0 0]'
        case Environment(extent="sphere"):
            return f'LightSource "infinite" {_rgb("L", light.radiance)}'
        case _:
            raise exporting.CannotExport(f"light '{light.id}': pbrt has no half a sky without an image of it")


def _surface(surface: Surface) -> str:
    return _solid(_shape(surface.shape, surface.side == "inside"), surface.reflectance, surface.radiance)


def _solid(shape: list[str], reflectance: float, radiance: float) -> str:
    """A diffuse shape that may shine."""
    glow = [f'AreaLightSource "diffuse" {_rgb("L", radiance)}'] if radiance else []
    lines = [f'Material "diffuse" {_rgb("reflectance", reflectance)}', *glow, *shape]
    return "\n".join(["AttributeBegin", *(f"  {line}" for line in lines), "AttributeEnd"])


def _rgb(name: str, value: float) -> str:
    return f'"rgb {name}" [{numbers([value] * 3)}]'


def _shape(shape: Shape, inside: bool = False) -> list[str]:
    turned = ["ReverseOrientation"] * inside
    match shape:
        case Sphere():
            return [*turned, f"Translate {numbers(shape.center)}", f'Shape "sphere" "float radius" [{shape.radius!r}]']
        case Cylinder():
            size = f'"float radius" [{shape.radius!r}] "float zmin" [0] "float zmax" [{shape.height!r}]'
            return [*turned, _placed(shape.base, shape.axis), f'Shape "cylinder" {size}']
        case Disk():
            return [_placed(shape.center, shape.normal), f'Shape "disk" "float radius" [{shape.radius!r}]']
        case Polygon() | Cap():
            return _triangles(mesh.tessellate(shape, inside))


def _placed(origin: geometry.Vec3, axis: geometry.Vec3) -> str:
    """The transform, column by column, that takes the third axis to `axis`."""
    return f"Transform [{numbers(pose(origin, *geometry.tangents(axis), geometry.unit(axis)).T)}]"


def _flat(corners: np.ndarray) -> mesh.Mesh:
    return mesh.Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]]))


def _triangles(shape: mesh.Mesh) -> list[str]:
    indices = " ".join(map(str, shape.triangles.ravel()))
    return [f'Shape "trianglemesh" "point3 P" [{numbers(shape.vertices)}] "integer indices" [{indices}]']
