"""Disks, spheres and cylinders as lights and as what stands before lights: proven at points, means estimated."""

from __future__ import annotations

from lightproof import geometry, scene
from lightproof.certify import outlines, parting, provenance
from lightproof.certify.arrangement import EVERYTHING, irradiance, visible
from lightproof.certify.balls import CannotCertify, Point, exact, unit
from lightproof.certify.curved_means import Means
from lightproof.certify.emitters import Formula, dark
from lightproof.certify.field import Field, Shape
from lightproof.certify.parting import Solid
from lightproof.certify.planes import Plane
from lightproof.certify.polygon import clip
from lightproof.certify.provenance import Provenance
from lightproof.scene import AreaLight

CURVED = geometry.Disk | geometry.Sphere | geometry.Cylinder


def covers(light: scene.Light, blockers: list[Shape]) -> bool:
    """Whether this module knows the light: one of area that has something before it, and is curved or behind a curve."""
    shapes = [light.shape, *blockers] if isinstance(light, AreaLight) and blockers else []
    return any(isinstance(shape, CURVED) for shape in shapes)


def provenance_of(light: AreaLight, blockers: list[Shape]) -> Provenance:
    """Where the formula comes from."""
    return provenance.OUTLINES


def field(light: AreaLight, blockers: list[Shape], receiver: Plane) -> Field:
    """The contour integral around what is seen of the light. Raises CannotCertify."""
    lamp, normal = parting.solid(light.shape), unit(receiver.normal)
    upper = EVERYTHING if parting.above(lamp, receiver) else outlines.half(receiver.normal)
    between = _between(lamp, blockers, receiver)

    def near(x: Point) -> Formula:
        if parting.below(lamp, receiver):
            return dark
        before = [outlines.seen(shape, x) for shape in between if _hides(shape, light, x)]
        seen = visible(outlines.lit(lamp, x), upper, before)
        return lambda y: exact(light.radiance) * irradiance(seen, normal)

    return Field(near, None, Means(lamp, between, light.radiance, near).flux)


def _between(lamp: Solid, blockers: list[Shape], receiver: Plane) -> list[Solid]:
    """The blockers above the horizon; of a polygon before a flat light just what is on the light's front."""
    solids = [shape for shape in map(parting.solid, blockers) if not parting.below(shape, receiver)]
    face = parting.face(lamp)
    if face is None:
        return solids
    return [part for shape in solids if (part := clip(shape, face.normal, face.offset) if isinstance(shape, tuple) else shape)]


def _hides(blocker: Solid, light: AreaLight, receiver: Point) -> bool:
    """Whether a blocker is in front of the light. Raises CannotCertify."""
    nearer = parting.in_front(blocker, parting.solid(light.shape), receiver)
    if nearer is None:
        name = "polygon" if isinstance(blocker, tuple) else type(blocker).__name__.lower()
        raise CannotCertify(f"no plane that was tried passes between light '{light.id}' and a {name}; a blocker that reaches"
                            " into a light, or round it, is not covered")
    return nearer
