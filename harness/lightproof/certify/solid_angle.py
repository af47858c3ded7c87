"""Films of solid angle: the directions in which a light is the first thing seen [sr], each counted once.

A light counts where its front is seen, whatever its radiance; its back, like a surface, only hides what is behind it.
"""

from __future__ import annotations

from collections.abc import Iterable

from flint import arb, fmpq

from lightproof import geometry, scene
from lightproof.certify import contact, provenance, round_angles
from lightproof.certify.balls import CannotCertify, Element, Point, dot, point, root
from lightproof.certify.loops import measure
from lightproof.certify.planes import Plane
from lightproof.certify.provenance import Provenance
from lightproof.certify.surroundings import Surroundings, face
from lightproof.scene import AreaLight, Environment, OvercastSky, PointsFilm, Scene, SunDisc, Surface

UP = (fmpq(0), fmpq(0), fmpq(1))
POLYGON = Provenance("ω = 2 π − Σ τᵢ, the turns τᵢ in the corners of what is seen, each loop for itself",
                     "Girard's spherical excess, on the visible part of the polygons.", ("todhunter1886", "arvo1994"))
CAP = Provenance("ω = 2 π (1 − cos a), sin a = R/d for a sphere; where it is cut ω = 2 π − Σ τᵢ − Σ φⱼ cos a, φⱼ arcs of the rim",
                 "The area of a spherical cap, and the Gauss-Bonnet theorem for parts of it.", ("todhunter1886",))
DISK = Provenance("ω = ∮ (1 − h/r) dφ along the rim, φ the azimuth about the foot of the perpendicular, of length h",
                  "Paxton's integral, evaluated with proven bounds.", ("paxton1959", "johansson2018"))
SKY = Provenance("ω = 4 π, 2 π above a horizon, less what hides the sky", "The area of a sphere and of a lune.",
                 ("todhunter1886",))
SOURCES = {geometry.Polygon: POLYGON, geometry.Sphere: CAP, geometry.Disk: DISK, scene.SunDisc: CAP, scene.Environment: SKY,
           scene.OvercastSky: SKY}


def covers(scene_: Scene) -> bool:
    """Whether the film is one of solid angle."""
    return scene_.film.quantity == "solid_angle"


def kind(scene_: Scene) -> str:
    """All of it is proven."""
    return "enclosure"


def provenance_of(scene_: Scene) -> Provenance:
    """That of each light, joined."""
    kinds = [type(light.shape) if isinstance(light, AreaLight) else type(light) for light in scene_.lights]
    return provenance.joined(SOURCES[kind] for kind in kinds if kind in SOURCES)


def solve(scene_: Scene) -> Element:
    """Visible solid angle, point by point. Raises CannotCertify."""
    film: PointsFilm = scene_.film
    for surface in scene_.surfaces:
        if surface.radiance > 0:
            raise CannotCertify(f"surface '{surface.id}' emits light of its own; give it as an area light")
    normals = [None] * len(film.positions) if film.normals is None else [point(normal) for normal in film.normals]
    return lambda element: _at(scene_, point(film.positions[element]), normals[element])


def _at(scene_: Scene, x: Point, normal: Point | None) -> arb:
    rounds = [thing for thing in (*scene_.lights, *scene_.surfaces) if _is_round(thing)]
    _check_contact(rounds, x, normal)
    around = _polygons(scene_, x)
    if normal is not None:
        around = around.above(Plane(normal, dot(normal, x)))
    skies = [light for light in scene_.lights if isinstance(light, Environment | OvercastSky)]
    suns = [light for light in scene_.lights if isinstance(light, SunDisc)]
    bright, dark = round_angles.sides(rounds, x)
    if not skies:
        return measure(around.seen, x) + round_angles.beside(around, normal, [*suns, *bright], dark)
    if any(getattr(sky, "extent", "upper") == "sphere" for sky in skies):
        hidden = measure(around.hidden, x) + round_angles.beside(around.swapped, normal, dark, bright)
        return (4 if normal is None else 2) * arb.pi() - hidden
    if suns or bright or dark:
        raise CannotCertify("a sun, or something round, together with half a sky is not covered in a film of solid angle")
    return _under_half(around, normal)


def _check_contact(rounds: Iterable[AreaLight | Surface], x: Point, normal: Point | None) -> None:
    for thing in rounds:
        if contact.touches(thing.shape, x, normal):
            raise CannotCertify(f"a receiver lies on '{thing.id}', from where a solid angle has no one value")


def _polygons(scene_: Scene, x: Point) -> Surroundings:
    things = [thing for thing in (*scene_.lights, *scene_.surfaces) if hasattr(thing, "shape") and not _is_round(thing)]
    faces = (face(thing.shape, x, light=isinstance(thing, AreaLight)) for thing in things)
    return Surroundings(x, tuple(filter(None, faces)))


def _is_round(thing: scene.Light | Surface) -> bool:
    return hasattr(thing, "shape") and not isinstance(thing.shape, geometry.Polygon)


def _under_half(around: Surroundings, normal: Point | None) -> arb:
    """The upper half of the sky, less what hides it, and lights in front of what is not sky."""
    level = Plane(UP, around.x[2])
    above, below = around.above(level), around.above(level.turned)
    return _upper(normal) - measure(above.hidden, around.x) + measure(below.seen, around.x)


def _upper(normal: Point | None) -> arb:
    """Solid angle [sr] of the upper half of the sky above a receiver's horizon: a lune."""
    if normal is None:
        return 2 * arb.pi()
    return 2 * (arb.pi() - arb.atan2(root(normal[0] ** 2 + normal[1] ** 2), arb(normal[2])))
