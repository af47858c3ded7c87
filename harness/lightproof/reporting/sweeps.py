"""What the hard cases sweep, told from a scene's geometry: the parameter of each of its points, so that a chart shows where a
method breaks; and what each does to the textbook's formula."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lightproof.geometry import Disk, Polygon, Sphere, unit
from lightproof.reporting.wording import amount
from lightproof.scene import Scene

BASE = "base"


@dataclass(frozen=True)
class Sweep:
    """`parameter` [`unit`] has a `value` (n,) for the points of a scene. Where cases sweep and not points, `across` has the
    names, without their numbers, of the cases that belong together; the base case belongs to the first."""

    parameter: str
    unit: str
    value: Callable[[Scene], np.ndarray]
    across: tuple[str, ...] = ()

    def group(self, case: str) -> str:
        """The cases that one chart shows: a name for them."""
        if not self.across:
            return case
        stem = case.rpartition("-")[0]
        return self.across[0] if case == BASE else stem if stem in self.across else case


def from_plane(scene: Scene) -> np.ndarray:
    """Distance of each point from the lamp's plane, or from its sphere [m]."""
    points, shape = np.array(scene.film.positions), scene.lights[0].shape
    match shape:
        case Sphere():
            return np.linalg.norm(points - shape.center, axis=1) - shape.radius
        case Disk():
            return np.abs((points - shape.center) @ unit(shape.normal))
    return np.abs((points - shape.vertices[0]) @ shape.normal)


def grazing(scene: Scene) -> np.ndarray:
    """Angle of the line from the lamp's middle to each point with the lamp's plane [degrees]."""
    shape = scene.lights[0].shape
    middle = np.mean(shape.vertices, axis=0) if isinstance(shape, Polygon) else np.array(shape.center)
    return np.degrees(np.arcsin(from_plane(scene) / np.linalg.norm(np.array(scene.film.positions) - middle, axis=1)))


def risen(scene: Scene) -> np.ndarray:
    """How much of the lamp, from its top down, is above each point's horizon [m]."""
    points, normals, shape = np.array(scene.film.positions), unit(np.array(scene.film.normals)), scene.lights[0].shape
    tops = np.array(shape.vertices) if isinstance(shape, Polygon) else np.array([shape.center])
    reach = 0 if isinstance(shape, Polygon) else shape.radius
    return np.max([((top - points) * normals).sum(axis=1) for top in tops], axis=0) + reach


def aspect(scene: Scene) -> np.ndarray:
    """Length over width of the lamp, for each point the same."""
    corners = np.array(scene.lights[0].shape.vertices)
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).max()
    area = scene.lights[0].shape.area * (2 if len(corners) == 3 else 1)
    return np.full(scene.size, longest**2 / area)


def lost(scene: Scene) -> np.ndarray:
    """1 - reflectance, for each point the same."""
    return np.full(scene.size, 1 - scene.surfaces[0].reflectance)


def moved(scene: Scene) -> np.ndarray:
    """How far the scene is from the origin [m], to the next power of ten, for each point the same."""
    return np.full(scene.size, 10.0 ** round(np.log10(np.abs(np.array(scene.film.positions)).max())))


NEAR = Sweep("distance to the lamp", "m", from_plane)
HORIZON = Sweep("height of the lamp over the horizon", "m", risen)
SWEEPS = {
    "hard-approach": NEAR,
    "hard-aspect": Sweep("aspect ratio", "", aspect, across=("strip", "triangle", "long")),
    "hard-distance": NEAR,
    "hard-grazing": Sweep("angle over the lamp's plane", "°", grazing),
    "hard-grazing:setting": HORIZON,
    "hard-grazing:sliver": HORIZON,
    "hard-reflectance": Sweep("1 − reflectance", "", lost, across=("one-in",)),
    "hard-touching-edge": NEAR,
    "hard-translation": Sweep("distance from the origin", "m", moved, across=("moved",)),
}

TEXTBOOK = {
    "hard-approach": (
        "Lambert's sum needs no distance and stays right, until the receiver looks along the lamp: without a horizon it counts "
        "what is below as negative light. The disk's root is of a difference that rounding makes negative."
    ),
    "hard-aspect": (
        "The angles of opposite edges differ in their last digits only, and arccos near 1 has half of those."
    ),
    "hard-degenerate-light": (
        "Nothing shines, and nothing is computed. A blocker without area leaves Lambert's sum as it was, which is wrong where "
        "the lamp's plane cuts the horizon."
    ),
    "hard-distance": (
        "Near the lamp the missing horizon costs its share at once. Far away Lambert's sum adds edges that cancel but for the "
        "light itself, which is smaller than the error of arccos; so does 1 − (…)/√… for the disk."
    ),
    "hard-grazing": (
        "The light is a small difference of long edges in Lambert's sum: what is left is rounding. Behind the horizon the sum "
        "goes on as if there were none, and Snyder's arccos has no digits left for the last of a sphere."
    ),
    "hard-in-plane": (
        "Edges seen end-on are 0/0: not a number. Where they are not, what should cancel leaves the last digit as light."
    ),
    "hard-reflectance": (
        "In float32 1 − ρ has lost its digits before the formula begins, and 1 − ρⁿ⁺¹ cancels on top of it."
    ),
    "hard-through-vertex": (
        "Clipping at an exact touch leaves corners that coincide, and the edge between them is 0/0."
    ),
    "hard-tiny-solid-angle": (
        "The spherical excess is a difference of sums of about π, arccos has no digits near 1, and 1 − cos is 0: what is left "
        "has nothing to do with the lamp."
    ),
    "hard-touching-edge": (
        "The edge in the receiver's plane is seen ever more end-on: its plane's normal is a quotient of rounding errors."
    ),
    "hard-translation": (
        "n · x − n · p in world coordinates takes two numbers of the size of the distance from the origin and keeps their "
        "difference, of the size of the scene."
    ),
}


def of(scene: Scene) -> Sweep | None:
    """What a scene sweeps; None where it is a list of cases without a parameter."""
    return SWEEPS.get(scene.name, SWEEPS.get(scene.id))


def values(scene: Scene) -> np.ndarray | None:
    """The parameter (n,) of a scene's points; None without one."""
    sweep = of(scene)
    return sweep and sweep.value(scene)


def place(scene: Scene, element: int) -> str:
    """An element by the sweep's parameter, or by its number."""
    parameter, sweep = values(scene), of(scene)
    if parameter is None:
        return f"at point {element}"
    return f"at {sweep.parameter} {amount(parameter[element], sweep.unit)} (point {element})"
