"""Scenes as Blender's objects: lamps, meshes, materials, the world and cameras.

Units as measured: a lamp's energy is a power; its radiance is energy / (pi area) where it is flat and energy / (4 pi^2 r^2)
where it is round, its intensity energy / (4 pi); a sun's energy is irradiance; a mesh's and the world's strength is radiance.
"""

from __future__ import annotations

import math
from types import ModuleType
from typing import Any

import numpy as np

from lightproof import geometry
from lightproof.geometry import Disk, Polygon, Shape, Sphere
from lightproof.renderers import mesh
from lightproof.renderers.views import View, pose
from lightproof.scene import AreaLight, DirectionalLight, Environment, Light, PointLight, Surface

GRID = 3  # subdivisions of an emitting polygon; on two large triangles Cycles is off by 2e-4
FAR = 1e6  # clip distance [m]


class Stage:
    """What is put into Blender's `collection`. With `lamps`, lights are lamps, which nothing sees and which block nothing."""

    def __init__(self, bpy: ModuleType, collection: Any, lamps: bool):
        self.bpy = bpy
        self.collection = collection
        self.lamps = lamps

    def light(self, light: Light) -> None:
        """Add a light; an environment is `world`'s."""
        match light:
            case PointLight():
                self._lamp(light.id, "POINT", 4 * np.pi * light.intensity, _at(light.position), shadow_soft_size=0.0)
            case DirectionalLight():
                self._lamp(light.id, "SUN", light.irradiance, _facing((0, 0, 0), light.direction), angle=0.0)
            case AreaLight() if self.lamps and has_lamp(light.shape):
                self._area_lamp(light)
            case AreaLight():
                self._mesh(light.id, _emitter(light.shape), 0.0, light.radiance)

    def surface(self, surface: Surface) -> None:
        """Add a surface that reflects and may emit."""
        build = _emitter if surface.radiance else mesh.tessellate
        self._mesh(surface.id, build(surface.shape, surface.side == "inside"), surface.reflectance, surface.radiance)

    def receiver(self, corners: np.ndarray, reflectance: float) -> None:
        """Add a diffuse rectangle, corners (4, 3)."""
        self._mesh("film-receiver", mesh.Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]])), reflectance, 0.0)

    def camera(self, view: View) -> Any:
        """Add a view's camera and return it."""
        data = self.bpy.data.cameras.new("film-camera")
        data.sensor_fit, data.clip_start, data.clip_end = "HORIZONTAL", view.near, FAR
        if view.projection == "orthographic":
            data.type, data.ortho_scale = "ORTHO", 2 * view.half[0]
        else:
            data.type, data.angle = "PERSP", 2 * math.atan(view.half[0])
        right, up, forward = geometry.camera_frame(view.origin, view.target, view.up)
        return self._object("film-camera", data, pose(view.origin, right, up, -forward))

    def _area_lamp(self, light: AreaLight) -> None:
        """Add a lamp of the light's own shape."""
        shape = light.shape
        match shape:
            case Sphere():
                energy = 4 * np.pi**2 * shape.radius**2 * light.radiance
                self._lamp(light.id, "POINT", energy, _at(shape.center), shadow_soft_size=shape.radius, use_soft_falloff=False)
            case Disk():
                energy = np.pi * shape.area * light.radiance
                self._lamp(light.id, "AREA", energy, _facing(shape.center, shape.normal), shape="DISK", size=2 * shape.radius)
            case Polygon():
                a, b, c, d = np.array(shape.vertices)
                place = pose((a + c) / 2, geometry.unit(b - a), geometry.unit(a - d), -shape.normal)
                size, size_y = float(np.linalg.norm(b - a)), float(np.linalg.norm(d - a))
                energy = np.pi * shape.area * light.radiance
                self._lamp(light.id, "AREA", energy, place, shape="RECTANGLE", size=size, size_y=size_y)

    def _lamp(self, name: str, kind: str, energy: float, place: np.ndarray, **fields: Any) -> None:
        data = self.bpy.data.lights.new(name, kind)
        for field, value in {"energy": energy, **fields}.items():
            setattr(data, field, value)
        self._object(name, data, place)

    def _mesh(self, name: str, shape: mesh.Mesh, reflectance: float, radiance: float) -> None:
        data = self.bpy.data.meshes.new(name)
        data.from_pydata(shape.vertices, [], shape.triangles)
        data.materials.append(material(self.bpy, name, reflectance, radiance))
        self._object(name, data, np.eye(4))

    def _object(self, name: str, data: Any, place: np.ndarray) -> Any:
        made = self.bpy.data.objects.new(name, data)
        made.matrix_world = place.T
        self.collection.objects.link(made)
        return made


def has_lamp(shape: Shape) -> bool:
    """Whether Blender has a lamp of a shape."""
    return isinstance(shape, Sphere | Disk) or (isinstance(shape, Polygon) and mesh.is_rectangle(np.array(shape.vertices)))


def material(bpy: ModuleType, name: str, reflectance: float, radiance: float) -> Any:
    """A Lambertian front that may emit; the back is black."""
    made = bpy.data.materials.new(name)
    made.cycles.emission_sampling = "FRONT"
    tree = made.node_tree
    tree.nodes.clear()
    back = tree.nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"]
    diffuse, emission = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeEmission")
    both, output = tree.nodes.new("ShaderNodeAddShader"), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(_front(tree, back, reflectance), diffuse.inputs["Color"])
    tree.links.new(_front(tree, back, radiance), emission.inputs["Strength"])
    tree.links.new(diffuse.outputs[0], both.inputs[0])
    tree.links.new(emission.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0] if radiance else diffuse.outputs[0], output.inputs["Surface"])
    return made


def _front(tree: Any, back: Any, value: float) -> Any:
    """A socket that is `value` on the front and 0 on the back."""
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = "MULTIPLY_ADD"
    tree.links.new(back, node.inputs[0])
    node.inputs[1].default_value, node.inputs[2].default_value = -value, value
    return node.outputs[0]


def world(bpy: ModuleType, skies: list[Environment]) -> Any:
    """The environments of a scene; black without any."""
    made = bpy.data.worlds.new("world")
    tree = made.node_tree
    background = tree.nodes["Background"]
    background.inputs["Color"].default_value = (1, 1, 1, 1)
    background.inputs["Strength"].default_value = sum(sky.radiance for sky in skies if sky.extent == "sphere")
    if any(sky.extent == "upper" for sky in skies):
        height = tree.nodes.new("ShaderNodeSeparateXYZ")
        tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], height.inputs[0])
        tree.links.new(_upper(tree, height.outputs["Z"], background, skies), background.inputs["Strength"])
    return made


def _upper(tree: Any, z: Any, background: Any, skies: list[Environment]) -> Any:
    above, strength = tree.nodes.new("ShaderNodeMath"), tree.nodes.new("ShaderNodeMath")
    above.operation, strength.operation = "GREATER_THAN", "MULTIPLY_ADD"
    above.inputs[1].default_value = 0
    tree.links.new(z, above.inputs[0])
    tree.links.new(above.outputs[0], strength.inputs[0])
    strength.inputs[1].default_value = sum(sky.radiance for sky in skies if sky.extent == "upper")
    strength.inputs[2].default_value = background.inputs["Strength"].default_value
    return strength.outputs[0]


def _at(centre: geometry.Vec3) -> np.ndarray:
    return pose(centre, *np.eye(3))


def _facing(centre: geometry.Vec3, direction: geometry.Vec3) -> np.ndarray:
    """A lamp's place; it shines along its own negative z."""
    t, b = geometry.tangents(direction)
    return pose(centre, b, t, -geometry.unit(direction))


def _emitter(shape: Shape, inside: bool = False) -> mesh.Mesh:
    """Triangles that emit: Cycles is biased by 2e-4 over the two large ones of a rectangle, and right over small ones."""
    return mesh.tessellate(shape, inside).subdivided(GRID if isinstance(shape, Polygon) else 0)
