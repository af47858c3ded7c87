"""The terms of a scene's direct light: closed forms where there are, else a look along all meridians (see `panorama`). That is
for cylinders, for what curved shapes shadow, for skies that anything shadows, and for solid angles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from lightproof.estimators import round_curves
from lightproof.estimators.analytic_limits import disks_unsupported, receiving_planes
from lightproof.estimators.blockers import Plane, encloses, standing
from lightproof.estimators.cells import HIGHEST
from lightproof.estimators.limits import no_caps
from lightproof.estimators.panorama import Panorama
from lightproof.estimators.round_lights import Rounds
from lightproof.estimators.shapes import parts
from lightproof.estimators.sheet import Sheet, tidied
from lightproof.estimators.sky_rows import SKIES, UP, sky_rows
from lightproof.estimators.supports import crossing, plane_of, reaches
from lightproof.estimators.terms import Term, farthest, obstacles, terms
from lightproof.estimators.terms import receivers as rows
from lightproof.estimators.touching import no_edge_below, nothing_touched
from lightproof.estimators.world import Item
from lightproof.geometry import Cylinder, Disk, Polygon, Shape, Sphere
from lightproof.scene import (
    AreaLight,
    CameraFilm,
    Light,
    PlaneFilm,
    PointsFilm,
    Scene,
    Surface,
)

ORDER = (Polygon, Disk, Sphere, Cylinder)  # of the shapes in `Solids`
AT_POINTS, IN_MEANS = 1e-12, 1e-9  # how far the two rules of a panorama may differ

Thing = Light | Surface


def all_terms(scene: Scene) -> list[Term]:
    """The direct light of a scene."""
    plain, rest = parted(scene)
    closed = [] if angular(scene) else terms(plain)
    closed = [with_curves(term, plain) if isinstance(term.source, Rounds) else term for term in closed]
    return [*closed, with_curves(Term(panorama(rest), tidied([]), HIGHEST), rest)] if shining(rest) else closed


def with_curves(term: Term, scene: Scene) -> Term:
    """A term of round shapes with the edges of their shadows on a plane film."""
    if not isinstance(scene.film, PlaneFilm):
        return term
    return replace(term, curves=tidied(round_curves.curves(Sheet.of(scene.film), scene)), most=HIGHEST)


def unsupported(scene: Scene) -> str | None:
    """Why some direct light has neither a closed form nor can be found by a look around."""
    things = standing(scene)
    tubes = [thing for thing in things if isinstance(thing.shape, Cylinder)]
    if tubes and isinstance(scene.film, CameraFilm):
        return f"its camera sees no cylinders ('{tubes[0].id}' is one)"
    on_something = nothing_touched(scene) if angular(scene) else no_edge_below(scene)
    return no_caps(scene) or on_something or (crossing(things) if shining(parted(scene)[1]) else None)


def receivers(scene: Scene) -> np.ndarray:
    """Rows (n, 12), see `terms.receivers`; where a film has no normals, any will do."""
    film = scene.film
    if isinstance(film, PointsFilm) and film.normals is None:
        film = replace(film, quantity="irradiance", normals=(UP,) * len(film.positions))
    return rows(replace(scene, film=film))


def angular(scene: Scene) -> bool:
    return scene.film.quantity == "solid_angle"


def shining(scene: Scene) -> bool:
    """Whether there are area lights or skies."""
    return any(isinstance(light, SKIES) for light in scene.lights) or any(thing.radiance for thing in standing(scene))


def parted(scene: Scene) -> tuple[Scene, Scene]:
    """The scene with the lights that have closed forms only, and with the others only; what does not shine still blocks."""
    things = {thing.id for thing in (*scene.lights, *scene.surfaces)}
    closed = set() if angular(scene) else with_closed_forms(scene)
    return without(scene, things - closed), without(scene, closed)


def with_closed_forms(scene: Scene) -> set[str]:
    """The ids of what has a closed form, if it shines."""
    faced = facing(scene)
    return {thing.id for thing in (*scene.lights, *scene.surfaces) if not needs_panorama(scene, thing, faced)}


def without(scene: Scene, names: set[str]) -> Scene:
    """The scene with some of its things dark."""
    lights = tuple(dark(light) if light.id in names else light for light in scene.lights)
    surfaces = tuple(replace(surface, radiance=0.0) if surface.id in names else surface for surface in scene.surfaces)
    return replace(scene, lights=tuple(filter(None, lights)), surfaces=surfaces)


def dark(light: Light) -> Light | None:
    """What is left of a light that is out: its shape."""
    return replace(light, radiance=0.0) if isinstance(light, AreaLight) else None


def needs_panorama(scene: Scene, thing: Thing, faced: list[Item]) -> bool:
    """Whether what shadows a light, or the light itself, has no closed form; `faced` may shadow some light."""
    if not isinstance(thing, SKIES | Item) or (isinstance(thing, Item) and not thing.radiance):
        return False
    shape = getattr(thing, "shape", None)
    if isinstance(shape, Polygon):
        faced = [other for other in faced if not isinstance(other.shape, Polygon)]
    shapes = before(thing, faced)
    if isinstance(shape, Disk) and len(shapes) == 1 and isinstance(shapes[0], Disk):
        return any(apart(shape, shapes[0], plane, thing.id) for plane in receiving_planes(scene))
    return isinstance(shape, Cylinder) or bool(shapes)


def apart(light: Disk, blocker: Disk, plane: Plane | None, name: str) -> bool:
    """Whether a disk does not stand parallel before a disk above the horizon."""
    (one,), (other,) = parts(light), parts(blocker)
    return disks_unsupported(one, other, plane, name) is not None


def before(thing: Thing, faced: list[Item]) -> list[Shape]:
    """What of `faced` may stand between a light and what receives it."""
    shape = getattr(thing, "shape", None)
    front = [plane_of(shape)] if isinstance(shape, Polygon | Disk) else []
    return [other.shape for other in faced if other is not thing and all(reaches(other.shape, *plane) for plane in front)]


def facing(scene: Scene) -> list[Item]:
    """What lies in front of anything else that receives."""
    places = list(receiving(scene))
    return [thing for thing in standing(scene)
            if any(thing is not own and (plane is None or reaches(thing.shape, *plane)) for own, plane in places)]


def receiving(scene: Scene) -> Iterator[tuple[Surface | None, Plane | None]]:
    """What receives, and the plane that it lies in, if any: a film, or before a camera the surfaces that reflect."""
    if not isinstance(scene.film, CameraFilm):
        yield from ((None, plane) for plane in receiving_planes(scene))
        return
    for surface in scene.surfaces:
        if surface.reflectance and not encloses(surface):
            yield surface, plane_of(surface.shape) if isinstance(surface.shape, Polygon | Disk) else None


def panorama(scene: Scene) -> Panorama:
    """The source for all that shines in a scene."""
    things, angle = sorted(standing(scene), key=lambda thing: ORDER.index(type(thing.shape))), angular(scene)
    glow = [float(isinstance(thing, AreaLight)) if angle else thing.radiance for thing in things]
    return Panorama(
        solids=obstacles([thing.shape for thing in things], farthest(scene)),
        glow=np.array(glow, float),
        skies=sky_rows(scene, angle),
        cosine=not angle,
        whole=angle and scene.film.normals is None,
        enough=AT_POINTS if isinstance(scene.film, PointsFilm) else IN_MEANS,
    )
