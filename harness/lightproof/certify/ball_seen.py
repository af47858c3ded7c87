"""A camera sees one sphere, alone under a sky that is the same everywhere: as bright as it glows and as what it reflects of
the sky, for nothing convex lights itself. Its outline is an ellipse in exact numbers, of which a pixel's part has a closed form.
"""

from __future__ import annotations

from flint import arb, fmpq

from lightproof import geometry, scene
from lightproof.certify import provenance
from lightproof.certify.balls import CannotCertify, Element, Rational, dot, exact, minus, point
from lightproof.certify.camera import Camera
from lightproof.certify.ellipse import Ellipse
from lightproof.certify.provenance import Provenance
from lightproof.scene import AreaLight, CameraFilm, Scene, Surface

UNSEEN = (scene.PointLight, scene.DirectionalLight)


def covers(scene_: Scene) -> bool:
    """Whether a camera has a sphere and no other shape to see."""
    return isinstance(scene_.film, CameraFilm) and [type(ball.shape) for ball in _solids(scene_)] == [geometry.Sphere]


def kind(scene_: Scene) -> str:
    """Areas in closed form."""
    return "enclosure"


def provenance_of(scene_: Scene) -> Provenance:
    """What a convex body shows, and its outline."""
    return provenance.BALL_SEEN


def solve(scene_: Scene) -> Element:
    """Mean radiance of each pixel. Raises CannotCertify."""
    (ball,), camera = _solids(scene_), Camera.of(scene_.film)
    sky = _sky(scene_)
    contrast = _shown(ball, scene_, sky) - sky
    if _inside(ball.shape, camera):
        return lambda element: arb(0)
    outline = _outline(ball.shape, camera)
    if not outline or not contrast:
        return lambda element: arb(sky)

    def element(index: int) -> arb:
        pixel = camera.pixel(index)
        share = outline.share(pixel)
        certain = share.is_exact() and share == outline.share(camera.wide(pixel))
        return sky + contrast * (share if certain else share + arb(0, camera.blur.abs_upper()))

    return element


def _solids(scene_: Scene) -> list[AreaLight | Surface]:
    return [*(light for light in scene_.lights if isinstance(light, AreaLight)), *scene_.surfaces]


def _sky(scene_: Scene) -> Rational:
    """The radiance of the sky. Raises CannotCertify where it is not the same everywhere."""
    skies = [light for light in scene_.lights if not isinstance(light, (AreaLight, *UNSEEN))]
    for light in skies:
        if not isinstance(light, scene.Environment) or light.extent != "sphere":
            raise CannotCertify(f"'{light.id}' is not the same everywhere; a sphere before a camera is covered alone under a sky"
                                " that is")
    return sum((exact(light.radiance) for light in skies), fmpq(0))


def _shown(ball: AreaLight | Surface, scene_: Scene, sky: Rational) -> Rational:
    """The radiance of the sphere's front. Raises CannotCertify where it reflects more than the sky."""
    glow = exact(ball.radiance)
    if isinstance(ball, AreaLight) or scene_.max_bounces == 0 or not ball.reflectance:
        return glow
    for light in scene_.lights:
        if isinstance(light, UNSEEN):
            raise CannotCertify(f"'{light.id}' lights the sphere '{ball.id}' from one side; before a camera, a sphere that"
                                " reflects is covered under a sky that is the same everywhere")
    return glow + exact(ball.reflectance) * sky


def _inside(sphere: geometry.Sphere, camera: Camera) -> bool:
    """Whether the camera is inside. Raises CannotCertify where it is on the sphere."""
    ray = minus(point(sphere.center), camera.origin)
    over = dot(ray, ray) - exact(sphere.radius) ** 2
    if over == 0 and not camera.parallel:
        raise CannotCertify("the camera lies on the sphere; what it sees is not defined there")
    return over < 0 and not camera.parallel


def _outline(sphere: geometry.Sphere, camera: Camera) -> Ellipse | None:
    """The outline on the film; None where all of the sphere is behind the camera. Raises CannotCertify."""
    ray, squared = minus(point(sphere.center), camera.origin), exact(sphere.radius) ** 2
    depth = dot(ray, camera.forward)
    if depth * depth <= squared * dot(camera.forward, camera.forward):
        raise CannotCertify("the sphere reaches from before the camera to behind it; its outline in the picture is no ellipse")
    if depth < 0:
        return None
    return Ellipse.of(_shadow(ray, squared, camera) if camera.parallel else _cone(ray, squared, camera))


def _cone(ray: tuple, squared: Rational, camera: Camera) -> tuple[Rational, ...]:
    """Where rays d hit a sphere: (ray . d)^2 >= (ray . ray - R^2) d . d."""
    sides = (camera.right, camera.up, camera.forward)
    x, y, z = (dot(ray, side) for side in sides)
    xx, yy, zz = ((dot(ray, ray) - squared) * dot(side, side) for side in sides)
    return xx - x * x, -x * y, yy - y * y, -x * z, -y * z, zz - z * z


def _shadow(ray: tuple, squared: Rational, camera: Camera) -> tuple[Rational, ...]:
    """Where parallel rays hit it: closer to its centre's than R."""
    x, y = dot(ray, camera.right), dot(ray, camera.up)
    xx, yy = (dot(side, side) for side in (camera.right, camera.up))
    return xx, fmpq(0), yy, -x, -y, x * x / xx + y * y / yy - squared
