"""Disks, spheres and cylinders in the first engine: against brute force, each other, and what physics demands."""

from __future__ import annotations

import math

import numpy as np
import pytest
from flint import arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st

from lightproof import geometry, scene_file
from lightproof.certify import cubature, many_outlines, parting
from lightproof.certify.arrangement import irradiance
from lightproof.certify.balls import CannotCertify, point, unit
from lightproof.certify.crossings import Wave
from lightproof.certify.engine import certify
from lightproof.certify.outlines import sphere as seen_sphere
from lightproof.certify.parting import in_front

SQUARE = [[-0.5, -0.4, 1.1], [-0.5, 0.6, 1.1], [0.5, 0.6, 1.1], [0.5, -0.4, 1.1]]
UP = (0, 0, 1)


def disk(centre, normal, radius):
    return {"type": "disk", "center": list(centre), "normal": list(normal), "radius": radius}


def ball(centre, radius):
    return {"type": "sphere", "center": list(centre), "radius": radius}


def tube(base, axis, height, radius):
    return {"type": "cylinder", "base": list(base), "axis": list(axis), "height": height, "radius": radius}


def polygon(vertices):
    return {"type": "polygon", "vertices": [list(vertex) for vertex in vertices]}


def value(light, blockers=(), at=(0, 0, 0), normal=UP):
    """The certified irradiance at a point, per radiance."""
    film = {"kind": "points", "quantity": "irradiance", "positions": [list(at)], "normals": [list(normal)]}
    lamp = {"kind": "area", "id": "lamp", "radiance": 1.0, "shape": light}
    surfaces = [{"id": f"blocker-{i}", "reflectance": 0, "shape": shape} for i, shape in enumerate(blockers)]
    table = {"title": "a test", "max_bounces": 0, "tolerance": 0.005, "film": film, "light": [lamp], "surface": surfaces}
    certified = certify(scene_file.from_table(table, "test"))
    assert certified.uncertainty[0] <= 1e-15 * max(certified.value[0], 1e-3)
    return certified.value[0]


def brute_force(light, blockers=(), at=(0, 0, 0), normal=UP, count=700):
    """Irradiance per radiance: rays in count^2 directions, as many as the cosine asks for, that meet the light's front first."""
    steps = (np.arange(count) + 0.5) / count
    sine, azimuth = (grid.ravel() for grid in np.meshgrid(np.sqrt(steps), 2 * np.pi * steps))
    t, b = geometry.tangents(normal)
    around = np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), np.sqrt(1 - sine**2)], axis=-1)
    rays = around @ [t, b, geometry.unit(normal)]
    with np.errstate(divide="ignore", invalid="ignore"):
        distance, front = meet(light, np.array(at, float), rays)
        seen = front & np.isfinite(distance)
        for shape in blockers:
            seen &= ~(meet(shape, np.array(at, float), rays)[0] < distance)
    return math.pi * seen.mean()


def meet(shape, x, rays):
    """(n,) How far rays go until they meet a shape, inf where they do not, and whether they meet its front."""
    match shape["type"]:
        case "polygon":
            return meet_polygon(np.array(shape["vertices"]), x, rays)
        case "disk":
            normal, spoke = geometry.unit(shape["normal"]), np.array(shape["center"]) - x
            t = spoke @ normal / (rays @ normal)
            inside = ((t[:, None] * rays - spoke) ** 2).sum(-1) < shape["radius"] ** 2
            return np.where(inside & (t > 0), t, np.inf), rays @ normal < 0
        case "sphere":
            spoke = x - np.array(shape["center"])
            return nearest(rays @ spoke, np.ones(len(rays)), spoke @ spoke - shape["radius"] ** 2, lambda t: t > 0)
        case "cylinder":
            axis, spoke = geometry.unit(shape["axis"]), x - np.array(shape["base"])
            across, offset = rays - np.outer(rays @ axis, axis), spoke - spoke @ axis * axis
            level, slope, half = spoke @ axis - shape["height"] / 2, rays @ axis, shape["height"] / 2
            return nearest(across @ offset, (across**2).sum(-1), offset @ offset - shape["radius"] ** 2,
                           lambda t: (t > 0) & (abs(level + t * slope) < half))


def nearest(half, square, constant, accepted):
    """The first accepted root of square t^2 + 2 half t + constant, and whether it is the smaller of the two."""
    root = np.sqrt(half**2 - square * constant)
    low, high = (-half - root) / square, (-half + root) / square
    return np.where(accepted(low), low, np.where(accepted(high), high, np.inf)), accepted(low)


def meet_polygon(corners, x, rays):
    """Rays against a polygon: edges crossed by a line in its plane are counted."""
    normal = geometry.unit(geometry.vector_area(corners))
    frame = np.stack(geometry.tangents(normal), axis=-1)
    t = (corners[0] - x) @ normal / (rays @ normal)
    p, q = ((x + t[:, None] * rays - corners[0]) @ frame).T
    flat = (corners - corners[0]) @ frame
    inside = np.zeros(len(rays), bool)
    for a, b in zip(flat, np.roll(flat, -1, axis=0), strict=True):
        inside ^= ((a[1] > q) != (b[1] > q)) & (p < a[0] + (q - a[1]) * (b[0] - a[0]) / (b[1] - a[1]))
    return np.where(inside & (t > 0), t, np.inf), rays @ normal < 0


LEANING = disk([0.1, 0, 1.1], [0.2, 0.1, -1], 0.4)
TUBE = tube([0, 0, 0.3], [0, 0, 1], 0.2, 0.25)
ASKEW = tube([-0.5, 0.1, 1], [1, 0.2, 0], 1.2, 0.1)


@pytest.mark.parametrize("args", [
    (LEANING, [], (0, 0, 0), (1, 0, 0.1)),
    (LEANING, [disk([0.05, 0.1, 0.5], [0, 0.3, 1], 0.2)]),
    (LEANING, [polygon([[-0.1, -0.1, 0.4], [0.3, -0.1, 0.4], [0.3, 0.2, 0.5], [0, 0.2, 0.5]])]),
    (LEANING, [polygon([[-0.3, -0.3, 0.4], [0.3, -0.3, 0.4], [0, 0, 0.4], [0, 0.3, 0.4]])]),
    (ball([0.1, 0, 1.1], 0.4), [ball([0, 0.1, 0.5], 0.15)]),
    (ball([0.6, 0, 0.1], 0.3), [ball([0.2, 0.1, 0.1], 0.1)]),
    (polygon(SQUARE), [ball([0.2, 0.1, 0.5], 0.25), ball([0.1, -0.1, 0.4], 0.15)], (0, 0, 0), (0, 0.5, 1)),
    (polygon(SQUARE), [ball([0, 0, 0.1], 0.3)], (0, 0, 0)),
    (ASKEW, []),
    (ASKEW, [], (1.5, 0, 0.9), (-0.1, 0, 1)),
    (ASKEW, [ball([0.1, 0.1, 0.5], 0.1)], (0.1, 0, 0), (0, -0.9, 0.1)),
    (tube([-0.5, 0.1, -0.2], [0, 0.5, 1], 1.2, 0.3), [], (0.5, 0, 0)),
    (polygon(SQUARE), [tube([0.2, 0.1, 0.3], [0.3, 0.2, 1], 0.4, 0.15)]),
    (polygon(SQUARE), [TUBE], (0.05, 0, 0)),
    (polygon(SQUARE), [TUBE], (0.05, 0, 0.4)),
    (polygon(SQUARE), [TUBE], (0.35, 0, 0)),
    (polygon(SQUARE), [TUBE], (0.35, 0, 0.3)),
    (polygon(SQUARE), [tube([0, 0, 0.4], [1, 0, 0.1], 0.6, 0.15)]),
], ids=range(18))  # fmt: skip
def test_brute_force(args):
    """Lights and blockers of every kind, concave ones, through the horizon, seen past their rims and from inside a tube: the
    share of half a million rays that meet the light first."""
    assert value(*args) == pytest.approx(brute_force(*args), abs=2e-3)


numbers = st.floats(-0.6, 0.6)


@given(numbers, numbers, numbers, numbers)
@settings(max_examples=15, deadline=None)
def test_a_sphere_is_its_polar_disk(x, y, p, q):
    """A sphere light of radius 0.3 and the disk on whose rim the receiver's rays touch it, behind a disk: the same."""
    centre, blocker = np.array([x, y, 1.2]), disk([p, q, 0.5], [0.1, 0, 1], 0.2)
    share = 1 - 0.09 / (centre @ centre)
    polar = disk(centre * share, -centre, 0.3 * math.sqrt(share))
    assert value(ball(centre, 0.3), [blocker]) == pytest.approx(value(polar, [blocker]), rel=1e-12, abs=1e-14)


@given(numbers, numbers, st.floats(0.1, 3))
@settings(max_examples=15, deadline=None)
def test_a_blocker_and_its_complement(x, y, turn):
    """A half of the disk light's plane is hidden by one large triangle, the other half by another: what each leaves adds up."""
    along, across = np.array([math.cos(turn), math.sin(turn), 0]), np.array([-math.sin(turn), math.cos(turn), 0])
    middle = np.array([x / 3, y / 3, 0.5])
    ends = middle - 60 * along, middle + 60 * along
    parts = [value(LEANING, [polygon([*ends, middle + sign * 60 * across][::sign])]) for sign in (-1, 1)]
    assert sum(parts) == pytest.approx(value(LEANING), rel=1e-12)


@given(numbers, numbers, st.floats(0.05, 0.3), st.floats(0.05, 0.3))
@settings(max_examples=15, deadline=None)
def test_blockers_never_add_light(x, y, first, second):
    """A ball, then a tube before a sphere light: each takes some light away or none."""
    light, near, far = ball([0.1, 0, 1.5], 0.3), ball([x, y, 0.8], first), tube([y, x, 0.1], [0.2, 0, 1], 0.3, second)
    lit = [value(light, blockers) for blockers in ([], [near], [near, far])]
    assert lit[0] >= lit[1] * (1 - 1e-15) and lit[1] >= lit[2] * (1 - 1e-15) >= 0


def test_an_umbra_is_exactly_dark():
    """Behind a ball that hides the whole light: 0, without uncertainty."""
    film = {"kind": "points", "quantity": "irradiance", "positions": [[0, 0, 0]], "normals": [list(UP)]}
    table = {"title": "a test", "max_bounces": 0, "tolerance": 0.005, "film": film,
             "light": [{"kind": "area", "id": "lamp", "radiance": 1.0, "shape": polygon(SQUARE)}],
             "surface": [{"id": "ball", "reflectance": 0, "shape": ball([0, 0, 0.4], 0.35)}]}
    certified = certify(scene_file.from_table(table, "test"))
    assert certified.value[0] == certified.uncertainty[0] == 0


def test_rims_that_touch():
    """A disk whose rim touches the light's from inside, as a receiver on the light's axis sees it: the difference of the
    textbook's two parallel disks."""
    hidden = (1 - 0.25 / math.sqrt((0.25 + 2 * 0.015625) ** 2 - 4 * 0.015625**2)) / 2
    seen = value(disk([0, 0, 2], [0, 0, -1], 1), [disk([0.125, 0, 0.5], [0, 0, 1], 0.125)])
    assert seen == pytest.approx(math.pi * (0.2 - hidden), rel=1e-14)


def test_outlines_that_coincide_are_refused():
    """A disk of exactly the light's apparent size, on the axis: no precision tells which is larger."""
    with pytest.raises(CannotCertify, match="coincide"):
        value(disk([0, 0, 2], [0, 0, -1], 1), [disk([0, 0, 1], [0, 0, 1], 0.5)])


@pytest.mark.parametrize(("light", "blocker", "at", "reason"), [
    (ball([0, 0, 1], 0.3), disk([0, 0, 0.8], [0.5, 0, 1], 0.4), (0, 0, 0), "reaches into a light"),
    (ball([0, 0, 1], 0.1), tube([0, 0, 0.8], UP, 0.4, 0.2), (0, 0, 0), "or round it"),
    (polygon(SQUARE), TUBE, (0.25, 0, 0), "in line with the wall"),
    (ball([0, 0, 1], 0.3), ball([0, 0, 0.3], 0.1), (0, 0, 0.9), "inside a sphere light"),
])  # fmt: skip
def test_refusals(light, blocker, at, reason):
    """What is not covered is refused with the reason."""
    with pytest.raises(CannotCertify, match=reason):
        value(light, [blocker], at)


def test_what_is_behind_the_light_hides_nothing():
    """A ball behind a square light, one behind a sphere light: the open light to the last bit."""
    for light in (polygon(SQUARE), ball([0, 0, 0.7], 0.2)):
        assert value(light, [ball([0.1, 0, 1.6], 0.4)]) == pytest.approx(value(light), rel=1e-15)


def test_a_plane_between_tells_what_is_in_front():
    """Two spheres, seen from both sides; spheres that overlap are not told apart."""
    near, far = (geometry.Sphere(center=(0.1, 0, z), radius=0.3) for z in (0.0, 1.0))
    assert in_front(near, far, point((0, 0, -5.0))) is True
    assert in_front(near, far, point((0, 0, 5.0))) is False
    assert in_front(near, geometry.Sphere(center=(0.1, 0, 0.5), radius=0.3), point((0, 0, -5.0))) is None


@given(st.lists(st.floats(-3, 3), min_size=5, max_size=5).filter(lambda c: max(map(abs, c[1:])) > 0.01))
@settings(max_examples=50, deadline=None)
def test_every_root_of_a_wave_is_found(coefficients):
    """Where level + x cos f + y sin f + u cos 2f + v sin 2f changes sign between two of 5,000 angles there is a ball."""
    angles = np.linspace(-math.pi, math.pi, 5001)
    level, x, y, u, v = coefficients
    heights = level + x * np.cos(angles) + y * np.sin(angles) + u * np.cos(2 * angles) + v * np.sin(2 * angles)
    with ctx.workprec(128):
        found = [math.remainder(float(root), 2 * math.pi) for root in Wave(*map(arb, coefficients)).roots()]
    for i in np.flatnonzero(np.sign(heights[1:]) * np.sign(heights[:-1]) < 0):
        gap = min(abs(math.remainder(root - angles[i:i + 2].mean(), 2 * math.pi)) for root in found)
        assert gap < 0.001


def test_the_contour_around_a_sphere():
    """A whole sphere on the normal: pi (R/d)^2."""
    with ctx.workprec(128):
        seen = irradiance(seen_sphere(point((0, 0, 2.0)), point((0.5,) * 3)[0]), unit(point((0, 0, 1.0))))
        assert seen.overlaps(arb.pi() / 16) and seen.rad() < 1e-30


SHADOWS = {
    "ball before a square": (polygon(SQUARE), [ball([0.1, -0.1, 0.6], 0.25)]),
    "disk before a disk": (LEANING, [disk([0.05, 0.1, 0.5], [0.4, 0.3, 1], 0.2)]),
    "parallel disks": (disk([0.1, 0, 1.1], [0, 0, -1], 0.4), [disk([0.05, 0.1, 0.5], UP, 0.2)]),
    "ball before a ball": (ball([0.3, 0, 0.9], 0.4), [ball([0, 0.1, 0.3], 0.15)]),
    "a concave polygon and a ball": (LEANING, [polygon([[-0.3, -0.3, 0.4], [0.3, -0.3, 0.4], [0, 0, 0.4], [0, 0.3, 0.4]]),
                                               ball([0.3, 0, 0.3], 0.1)]),
}


@pytest.mark.parametrize("name", SHADOWS)
def test_many_receivers_at_once(name):
    """Twenty receivers on a floor, in binary64 and proven: equal to 13 digits of the largest."""
    light, blockers = SHADOWS[name]
    positions = np.random.default_rng(2).uniform(-1, 1, (20, 3)) * [1, 1, 0]
    own = floor(light, blockers, (1, 1))
    lamp, *before = (parting.solid(item.shape) for item in (*own.lights, *own.surfaces))
    at_once = many_outlines.irradiance(lamp, before, positions, np.array([0, 0, 1.0]))
    assert at_once == pytest.approx([value(light, blockers, at) for at in positions.tolist()], abs=1e-13 * at_once.max())


def floor(light, blockers, resolution):
    """A scene with a film of 0.8 m x 0.6 m."""
    film = {"kind": "plane", "quantity": "irradiance", "origin": [-0.3, -0.2, 0], "u": [0.8, 0, 0], "v": [0, 0.6, 0],
            "resolution": list(resolution)}
    surfaces = [{"id": f"blocker-{i}", "reflectance": 0, "shape": shape} for i, shape in enumerate(blockers)]
    return scene_file.from_table({"title": "a test", "max_bounces": 0, "tolerance": 0.005, "film": film, "surface": surfaces,
                                  "light": [{"kind": "area", "id": "lamp", "radiance": 1.0, "shape": light}]}, "test")


@pytest.mark.parametrize("name", ["ball before a square", "parallel disks"])
def test_means_add_up(name):
    """The mean over a film of one element and over the same film of 3 x 2: equal within what they state, called estimates."""
    one, six = (certify(floor(*SHADOWS[name], resolution)) for resolution in ((1, 1), (3, 2)))
    assert one.kind == six.kind == "quadrature"
    assert one.uncertainty[0] < 1e-6 * one.value[0]
    assert one.value[0] == pytest.approx(six.value.mean(), rel=0, abs=one.uncertainty[0] + six.uncertainty.mean())


def test_means_behind_a_tube_are_refused():
    """A cylinder before a light, over a film."""
    with pytest.raises(CannotCertify, match=r"cylinder.*at points only"):
        certify(floor(polygon(SQUARE), [TUBE], (1, 1)))


def test_means_of_a_light_that_the_film_cuts_are_refused():
    """A tube through the film's plane, alone."""
    with pytest.raises(CannotCertify, match="along curves of the film"):
        certify(floor(tube([0.7, 0, -0.5], [0.1, 0, 1], 1, 0.1), [], (1, 1)))


def test_a_kink_is_estimated_honestly():
    """|s - 0.3|^(3/2) over the square: within the uncertainty, which is as small as was asked for, or nearly."""
    total, uncertainty = cubature.integral(lambda s, t: np.abs(s - 0.3) ** 1.5, 1e-8)
    expected = 2 * (1.3**2.5 + 0.7**2.5) / 2.5
    assert abs(total - expected) < uncertainty < 1e-6
