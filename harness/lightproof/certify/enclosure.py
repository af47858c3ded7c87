"""Inside a closed room of one reflectance everywhere, convex and made of polygons: what its walls glow with, and the light of
a point in a cube's centre."""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb

from lightproof.certify import planes, rooms, series
from lightproof.certify.balls import CannotCertify, Element, cross, exact, plus, point
from lightproof.certify.planes import Frame
from lightproof.certify.provenance import Provenance
from lightproof.certify.rooms import Corners
from lightproof.scene import CameraFilm, PlaneFilm, PointLight, Scene

GLOW = Provenance(
    "L = L_e (1 + ρ + ρ² + …) = L_e/(1 − ρ), E = π L",
    "A closed cavity that is alike everywhere sends the same radiance every way: what arrives anywhere is π times it.",
    ("howell",),
)
CUBE = Provenance(
    "mean of E = Φ/(S (1 − ρ)), Φ = 4 π I, S = 6 a²",
    "No light is lost between closed walls: of the flux that arrives, ρ arrives again. Seen from a cube's centre, its walls are"
    " alike.",
    ("jacquez1955",),
)


def covers(scene: Scene) -> bool:
    """Whether a room is closed and light is not only direct."""
    lit = scene.reflects or any(surface.radiance > 0 for surface in scene.surfaces)
    return lit and scene.film.quantity != "solid_angle" and rooms.is_closed(scene.surfaces)


def kind(scene: Scene) -> str:
    """Closed forms."""
    return "enclosure"


def provenance_of(scene: Scene) -> Provenance:
    """Where the formula comes from."""
    return CUBE if scene.lights else GLOW


def solve(scene: Scene) -> Element:
    """The same value for each element. Raises CannotCertify."""
    room = rooms.walls(scene.surfaces)
    wall = scene.surfaces[0]
    if any((other.reflectance, other.radiance) != (wall.reflectance, wall.radiance) for other in scene.surfaces):
        raise CannotCertify("the walls of the room differ; one reflectance and one radiance everywhere are covered")
    own = exact(wall.radiance) * series.geometric(exact(wall.reflectance), scene.max_bounces)
    if isinstance(scene.film, CameraFilm):
        return _seen(scene, room, own)
    _check_films(scene, room)
    lit = _lit(scene, room) * series.geometric(exact(wall.reflectance), scene.max_bounces) if scene.lights else arb(0)
    return lambda element: arb.pi() * own + lit


def _seen(scene: Scene, room: Sequence[Corners], own: arb) -> Element:
    """The radiance that a camera inside sees, whichever way it looks."""
    if scene.lights or scene.film.projection == "orthographic":
        raise CannotCertify("in a room, a perspective camera is covered where the walls alone shine")
    eye = point(scene.film.origin)
    if any(planes.of(wall).height(eye) <= 0 for wall in room):
        raise CannotCertify("the camera does not stand inside the room")
    return lambda element: own


def _check_films(scene: Scene, room: Sequence[Corners]) -> None:
    """Every element is in the room."""
    film = scene.film
    if isinstance(film, PlaneFilm):
        rooms.check_within(room, _outline(film), cross(point(film.u), point(film.v)))
        return
    for position, normal in zip(film.positions, film.normals, strict=True):
        rooms.check_within(room, [point(position)], point(normal))


def _outline(film: PlaneFilm) -> Corners:
    frame = Frame.of(film)
    return frame.origin, plus(frame.origin, frame.u), plus(frame.origin, plus(frame.u, frame.v)), plus(frame.origin, frame.v)


def _lit(scene: Scene, room: Sequence[Corners]) -> arb:
    """Direct irradiance of a wall of a cube from the point in its centre, the mean over the wall, its halves or quarters."""
    light, film = scene.lights[0], scene.film
    if len(scene.lights) > 1 or not isinstance(light, PointLight) or not rooms.is_middle_of_cube(room, point(light.position)):
        raise CannotCertify("in a room, walls that glow are covered, and one point light in the exact centre of an exact cube")
    on_wall = isinstance(film, PlaneFilm) and any(sorted(_outline(film)) == sorted(wall) for wall in room)
    if not on_wall or max(film.resolution) > 2:
        raise CannotCertify("of a point light in a cube, the mean over a whole wall, its halves or quarters is known")
    return 4 * arb.pi() * exact(light.intensity) / rooms.area(room)
