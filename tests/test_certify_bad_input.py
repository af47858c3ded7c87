"""Bad and degenerate input, through scene files, `lightproof certify` and every method: the right value or a clear refusal."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from flint import arb
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from lightproof import films, scene_file, sketch
from lightproof.certify import engine
from lightproof.certify.balls import CannotCertify, Undecided, dot, exact, minus, point
from lightproof.certify.engine import certify
from lightproof.certify.polygon import area_vector
from lightproof.checked import SceneError
from lightproof.cli import main
from lightproof.geometry import Polygon
from lightproof.renderers.registry import METHODS, OURS
from lightproof.renderers.worker import Host
from lightproof.reporting import framing

CEILING = [[0, 0, 2], [0, 1, 2], [1, 1, 2], [1, 0, 2]]  # faces down
TABLE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]  # faces up
LINE = [[0, 0.25, 1], [0.25, 0.5, 1], [0.75, 1, 1]]
A_LITTLE = 2.0**-30


def polygon(vertices):
    return {"type": "polygon", "vertices": [[float(number) for number in vertex] for vertex in vertices]}


def lamp(shape, name="lamp", radiance=2.0):
    """An area light; `shape` is a table, or the vertices of a polygon."""
    return {"kind": "area", "id": name, "radiance": radiance, "shape": shape if isinstance(shape, dict) else polygon(shape)}


def blocker(shape, name="blocker"):
    return {"id": name, "reflectance": 0, "shape": shape if isinstance(shape, dict) else polygon(shape)}


def table(lights, surfaces=(), position=(0.25, 0.5, 0), normal=(0, 0, 1), film=None):
    """A scene of one receiver."""
    film = film or {"kind": "points", "quantity": "irradiance", "positions": [list(position)], "normals": [list(normal)]}
    things = {"light": list(lights), "surface": list(surfaces), "film": film}
    return {"title": "a test", "max_bounces": 0, "tolerance": 0.005} | things


def value(*args, **more):
    """The certified irradiance of one receiver, and what it may be off by, which has to be little."""
    certified = certify(scene_file.from_table(table(*args, **more), "test"))
    assert certified.uncertainty[0] <= 1e-15 * max(1, certified.value[0])
    return certified.value[0]


WRONG = {
    "bow tie": ([[0, 0, 1], [1, 1, 1], [1, 0, 1], [0, 1, 1]], "the polygon has no area, yet is no line: its edges cross"),
    "crossed": ([[0, 0, 1], [0, 3, 1], [2, 0, 1], [2, 1, 1]], "vertices: edges 1 and 3 cross or touch; give a simple polygon"),
    "bent": ([[0, 0, 1], [1, 0, 1], [1, 1, 1.3], [0, 1, 1]], "m off the plane of the others; at most 1e-09 m is accepted"),
    "huge and bent": ([[0, 0, 0], [1e150, 0, 0], [1e150, 1e150, 1e149], [0, 1e150, 0]], "off the plane of the others"),
    "astronomical": ([[0, 0, 1], [1e151, 0, 1], [0, 1, 1]], "1e+151 is out of range; give numbers from -1e+150 to 1e+150"),
    "minute": ([[0, 0, 0], [1e-160, 0, 0], [0, 1e-160, 0]], "the polygon is 1e-160 m wide; at least 1e-150 m is accepted"),
    "no radius": ({"type": "disk", "center": [0, 0, 1], "normal": [0, 0, -1], "radius": 0}, "radius: 0 is out of range"),
    "no ball": ({"type": "sphere", "center": [0, 0, 1], "radius": 0}, "radius: 0 is out of range"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_shapes_are_refused_with_the_reason(name):
    """As a light and as a blocker, with the place and the remedy."""
    shape, reason = WRONG[name]
    for lights, surfaces, where in (([lamp(shape)], (), "light.lamp."), ([lamp(CEILING)], [blocker(shape)], "surface.blocker.")):
        with pytest.raises(SceneError) as caught:
            scene_file.from_table(table(lights, surfaces), "test")
        assert str(caught.value).startswith(f"{where}shape.") and reason in str(caught.value)


def test_the_command_line_passes_the_reason_on(tmp_path, capsys):
    """A crossed polygon is bad input (2), a lamp with a blocker in its own plane is not certified (3), and nothing is written."""
    scenes = tmp_path / "scenes"
    scenes.mkdir()
    (scenes / "crossed.toml").write_text(_toml(WRONG["crossed"][0], CEILING))
    (scenes / "flush.toml").write_text(_toml(CEILING, [[0.5, 0, 2], [2, 0, 2], [2, 1, 2]]))
    assert main(["certify", str(scenes / "crossed.toml")]) == 2
    assert "light.lamp.shape.vertices: edges 1 and 3 cross" in capsys.readouterr().err
    assert main(["certify", str(scenes / "flush.toml")]) == 3
    assert "not certified: flush: 'lamp' and 'blocker' overlap in one plane" in capsys.readouterr().out
    assert not (tmp_path / "references").exists()


def _toml(light, surface) -> str:
    return f"""title = "a test"
max_bounces = 0
tolerance = 0.005
light = [{{ id = "lamp", kind = "area", radiance = 2, shape = {{ type = "polygon", vertices = {light} }} }}]
surface = [{{ id = "blocker", reflectance = 0, shape = {{ type = "polygon", vertices = {surface} }} }}]
film = {{ kind = "points", quantity = "irradiance", positions = [[0.25, 0.5, 0]], normals = [[0, 0, 1]] }}
"""


@pytest.mark.parametrize("method", [name for name, entry in METHODS.items() if entry.worker == OURS and "/" not in name])
@pytest.mark.parametrize("vertices", [LINE, [LINE[0], LINE[2], LINE[2], LINE[0]], [LINE[1]] * 3], ids=["line", "back", "point"])
def test_a_light_without_area_gives_nothing(tmp_path, method, vertices):
    """Exactly 0 by every method of ours, at a point right below, and on a floor."""
    floor = {"kind": "plane", "quantity": "irradiance", "origin": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0], "resolution": [2, 2]}
    host = Host()
    host.open(method, METHODS[method].target, 1)
    for film in (None, floor)[:1 if method == "textbook" else 2]:  # its formulas are for points
        scene = table([lamp(vertices)], film=film)
        assert "unsupported" not in host.prepare(method, "test", "base", scene)
        host.render(method, 64, 1, str(tmp_path / "film.exr"))
        assert not films.read(tmp_path / "film.exr")[1]["Y"].any()
        assert not certify(scene_file.from_table(scene, "test")).value.any()


def test_what_has_no_area_hides_nothing():
    """A line before a lamp: certified, sketched and framed as if it were not there."""
    open_sky, hidden = value([lamp(CEILING)]), value([lamp(CEILING)], [blocker(LINE)])
    assert hidden == open_sky > 0.4
    scene = scene_file.from_table(table([lamp(CEILING), lamp(LINE, "line")], [blocker(LINE)]), "test")
    assert [item.id for item in (*scene.tangible.lights, *scene.tangible.surfaces)] == ["lamp"]
    assert sketch.irradiance(scene, np.array([0]), {"all": sketch.share})["all"] == pytest.approx(open_sky, rel=1e-2)
    assert not sketch.can(scene_file.from_table(table([lamp(LINE)]), "test"))
    assert np.isfinite(framing.region(scene.tangible).size)


@pytest.mark.parametrize("aspect", [1e-3, 1e-8, 1e-13])
def test_slivers_keep_their_normal(aspect):
    """A tilted triangle of any width that is not a line: its normal is across its sides to the last digits."""
    shape = Polygon(((0.1, 0.2, 0.3), (1.1, 0.5, 1.0), (1.1, 0.5, 1.0 + aspect)))
    assert not shape.is_degenerate
    assert np.array([0.3, -1.0, 0.0]) / math.hypot(0.3, 1) == pytest.approx(shape.normal, abs=1e-15)


@pytest.mark.parametrize("normal", [(0.6, 0.2, 1), (1, 0, 0.25), (-3, 1, 2)])
def test_the_middle_of_a_light_seen_from_itself(normal):
    """A receiver in the middle of a lamp, tilted against it by beta: pi L (1 - cos beta)/2 of the plane is above its horizon."""
    cosine = normal[2] / math.hypot(*normal)
    assert value([lamp(TABLE)], position=(0.25, 0.5, 0), normal=normal) == pytest.approx(math.pi * (1 - cosine), rel=1e-15)


@pytest.mark.parametrize("position", [(0.25, 0.5, 0), (0.5, 0, 0), (1, 1, 0), (2, 0.5, 0)])
@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0.5, 0.25, -1)])
def test_in_the_light_s_plane_and_not_facing_it(position, normal):
    """On a lamp, its edge, its corner and beside it: a receiver that does not come from the front gets exactly nothing."""
    assert value([lamp(TABLE)], position=position, normal=normal) == 0


NEAR = {
    "on the light": ((0.25, 0.5, 0), TABLE, ()),
    "on its edge": ((0.5, 0, 0), TABLE, ()),
    "on its corner": ((1, 1, 0), TABLE, ()),
    "through a blocker": ((0.5, 0.5, 0), CEILING, ([[0, 0, -0.5], [1, 0, 0.5], [1, 1, 0.5], [0, 1, -0.5]],)),
    "on a blocker's edge": ((0.5, 0.5, 0), CEILING, ([[0.5, 0, 0], [0.5, 1, 0], [1, 1, 1], [1, 0, 1]],)),
    "on its end": ((0.5, 0.5, 0), CEILING, ([[0.5, 0.5, 0], [1, 1, 1], [1, 0, 1]],)),
    "in a corner of two": ((0.5, 0.5, 0), CEILING, ([[0.5, 0, -1], [0.5, 1, -1], [0.5, 1, 1], [0.5, 0, 1]],
                                                    [[0, 0.5, 0], [1, 0.5, 0], [1, 1, 1], [0, 1, 1]])),
}  # fmt: skip


@pytest.mark.parametrize("normal", [(0.75, 0.25, 1), (-0.75, 0.5, 1), (1, 0.25, 0.5), (-0.5, -1, 0.25)])
@pytest.mark.parametrize("name", NEAR)
def test_receivers_that_lie_on_something_see_the_limit(name, normal):
    """What a receiver on a lamp or a blocker gets is what it gets 1e-9 m before, on the side that its normal points to."""
    position, light, solids = NEAR[name]
    before = [number + A_LITTLE * component for number, component in zip(position, normal, strict=True)]
    surfaces = [blocker(vertices, f"blocker-{index}") for index, vertices in enumerate(solids)]
    here, there = (value([lamp(light)], surfaces, at, normal) for at in (position, before))
    assert here == pytest.approx(there, abs=1e-7)


@pytest.mark.parametrize("normal", [(0.75, 0.25, 1), (-0.5, -1, 0.25)])
@pytest.mark.parametrize("sky", [{"radiance": 1}, {"sky": "cie-overcast", "zenith_radiance": 1}], ids=["uniform", "overcast"])
def test_under_a_sky_too(sky, normal):
    """A receiver on a sheet that leans over it: the sky beyond, from its own side."""
    light, sheet = {"kind": "environment", "id": "sky"} | sky, blocker([[0, 0, -1], [1, 0, -1], [1, 1, 1], [0, 1, 1]])
    before = [number + A_LITTLE * component for number, component in zip((0.5, 0.5, 0), normal, strict=True)]
    here, there = (value([light], [sheet], at, normal) for at in ((0.5, 0.5, 0), before))
    assert 0 < here == pytest.approx(there, abs=1e-7)


@pytest.mark.parametrize(("lights", "surfaces", "position", "reason"), [
    ([lamp({"type": "disk", "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 0.5})], [], (0.25, 0, 0), "lies on 'lamp'"),
    ([lamp({"type": "sphere", "center": [0, 0, -0.5], "radius": 0.5})], [], (0, 0, 0), "lies on 'lamp'"),
    ([lamp({"type": "sphere", "center": [0, 0, 0], "radius": 0.5})], [], (0, 0, 0.25), "inside a sphere light"),
    ([{"kind": "point", "id": "bulb", "position": [0, 0, 3], "intensity": 1}],
     [blocker([[0, 0, -1], [1, 0, -1], [1, 1, 1], [0, 1, 1]])], (0.5, 0.5, 0), "lies on 'blocker'"),
    ([lamp(CEILING)], [blocker({"type": "cylinder", "base": [0, 0, -1], "axis": [1, 0, 1], "height": 3, "radius": 0.5})],
     (1, 0.5, 0), "lies on 'blocker'"),
    ([lamp(CEILING)], [blocker([[0.5, 0, 2], [2, 0, 2], [2, 1, 2]])], (0, 0, 0), "'lamp' and 'blocker' overlap in one plane"),
    ([lamp(CEILING), lamp(CEILING[::-1], "other")], [], (0, 0, 0), "'lamp' and 'other' overlap in one plane"),
    ([lamp(CEILING, radiance=1e308)], [], (0.5, 0.5, 1.99), "exceeds what a binary64 can hold"),
])  # fmt: skip
def test_what_is_not_known_is_refused(lights, surfaces, position, reason):
    """Receivers on round things, what overlaps in one plane, and more light than a number holds."""
    with pytest.raises(CannotCertify, match=reason):
        value(lights, surfaces, position, (0.25, 0.125, 1))


def test_only_what_is_between_blocks():
    """A blocker through the lamp and one through the floor hide as much as what of them is between; neighbours in the lamp's
    plane that share an edge with it hide nothing."""
    through = [[0.5, 0, 1], [0.5, 1, 1], [0.75, 1, 3], [0.75, 0, 3]]
    between = [[0.5, 0, 1], [0.5, 1, 1], [0.625, 1, 2], [0.625, 0, 2]]
    assert value([lamp(CEILING)], [blocker(through)]) == value([lamp(CEILING)], [blocker(between)])
    rising = [[0.5, 0, -1], [0.5, 1, -1], [0.75, 1, 1], [0.75, 0, 1]]
    risen = [[0.625, 0, 0], [0.625, 1, 0], [0.75, 1, 1], [0.75, 0, 1]]
    assert value([lamp(CEILING)], [blocker(rising)]) == value([lamp(CEILING)], [blocker(risen)])
    assert value([lamp(CEILING)], [blocker([[1, 0, 2], [1, 1, 2], [2, 1, 2]])]) == value([lamp(CEILING)])


@pytest.mark.parametrize("power", [-480, -330, 330, 480])
@pytest.mark.parametrize("shape", [polygon(CEILING), {"type": "sphere", "center": [0, 1, 2], "radius": 0.75},
                                   {"type": "disk", "center": [0, 1, 2], "normal": [0, -1, -2], "radius": 0.75}], ids=str)
def test_scale_changes_nothing(shape, power):
    """From 1e-145 m to 1e144 m, in powers of two, which are exact: the same irradiance to the last bit."""
    scale = 2.0**power
    larger = {key: (np.array(numbers) * scale).tolist() if key in ("vertices", "center", "radius") else numbers
              for key, numbers in shape.items()}
    position, normal = (0.25, 0.5, 0.125), (0.25, 0.125, 1)
    scaled = tuple(number * scale for number in position)
    assert value([lamp(larger)], position=scaled, normal=normal) == value([lamp(shape)], position=position, normal=normal)


def test_our_methods_refuse_lengths_that_they_would_lose():
    """1e12 m and 1e-12 m are refused in float32, with the range."""
    host = Host()
    host.open("mc-area", METHODS["mc-area"].target, 1)
    for scale in (1e12, 1e-12):
        scene = table([lamp((np.array(CEILING) * scale).tolist())], position=(0.25 * scale, 0, 0))
        assert "out of its range of 1e-09 to 1e+09 m" in host.prepare("mc-area", "test", "base", scene)["unsupported"]


def test_a_sphere_that_just_touches_the_horizon():
    """Radius 5 around (3, 4, 0), and the plane through the origin across (3, 4, 0): whole from the front, black from behind."""
    ball = {"type": "sphere", "center": [3, 4, 0], "radius": 5}
    expected = 2 * math.pi * 25 / 131 * 5 / math.sqrt(131)  # the squared distance is 1 + 49 + 81
    assert value([lamp(ball)], position=(4, -3, 9), normal=(3, 4, 0)) == pytest.approx(expected, rel=1e-15)
    assert value([lamp(ball)], position=(4, -3, 9), normal=(-3, -4, 0)) == 0


HALVES = st.sampled_from([-1.0, -0.5, 0.0, 0.5, 1.0])
CORNERS = st.lists(st.tuples(HALVES, HALVES, HALVES), min_size=3, max_size=3)


@given(CORNERS, st.lists(CORNERS, max_size=2), st.tuples(HALVES, HALVES, HALVES), st.tuples(HALVES, HALVES, HALVES))
@settings(max_examples=60, deadline=None)
def test_triangles_that_touch_in_every_way(light, solids, position, normal):
    """Corners on a grid of half metres, so that what can touch does: never more light than without blockers, and what arrives is
    the limit from the receiver's side, unless that runs along a triangle it lies on."""
    assume(any(normal))
    surfaces = [blocker(corners, f"blocker-{index}") for index, corners in enumerate(solids)]
    before = [number + A_LITTLE * component for number, component in zip(position, normal, strict=True)]
    try:
        here, there = (value([lamp(light)], surfaces, at, normal) for at in (position, before))
    except CannotCertify as refusal:
        assert "overlap in one plane" in str(refusal)
        return
    assert 0 <= here <= value([lamp(light)], (), position, normal) + 1e-15
    assert here == pytest.approx(there, abs=1e-6) or any(_runs_along(corners, position, normal) for corners in (light, *solids))


def _runs_along(corners, position, normal) -> bool:
    """Whether a receiver is in a triangle's plane and leaves it neither way."""
    a, *_ = exactly = [point(corner) for corner in corners]
    front = area_vector(exactly)
    return dot(front, minus(point(position), a)) == 0 and dot(front, point(normal)) == 0


class Ladder:
    """A solver whose answer, a third, is known to as many bits as it is given beyond `lost`, and decided beyond `undecided`."""

    __name__ = "ladder"

    def __init__(self, lost: int, undecided: int = 0):
        self.lost, self.undecided = lost, undecided

    def covers(self, scene) -> bool:
        return True

    def kind(self, scene) -> str:
        return "enclosure"

    def solve(self, scene):
        bits = engine.ctx.prec

        def element(index):
            if bits <= self.undecided:
                raise Undecided("it touches too closely")
            return arb(exact(1.0) / 3, exact(2.0) ** (self.lost - bits))

        return element


@pytest.mark.parametrize(("lost", "undecided"), [(0, 0), (100, 0), (900, 0), (0, 600), (1500, 1100)])
def test_precision_rises_until_a_value_is_narrow(monkeypatch, lost, undecided):
    """A value that costs hundreds of bits, or a side that takes them to decide, comes out as the nearest binary64."""
    monkeypatch.setattr(engine, "SOLVERS", (Ladder(lost, undecided),))
    certified = certify(scene_file.from_table(table([lamp(CEILING)]), "test"))
    assert certified.value[0] == 1 / 3 and certified.uncertainty[0] < 2e-17


def test_what_no_precision_decides_is_refused(monkeypatch):
    """Undecided at 4096 bits, it says so."""
    monkeypatch.setattr(engine, "SOLVERS", (Ladder(0, 10**6),))
    with pytest.raises(CannotCertify, match="touches too closely"):
        certify(scene_file.from_table(table([lamp(CEILING)]), "test"))


def test_hard_cases_hold_where_values_are_tiny():
    """Each value of the sweeps is known to a thousandth of its own tolerance and better: 60 bits of itself."""
    root = Path(__file__).parents[1] / "scenes"
    for path in sorted(root.glob("hard-*.toml")):
        if tomllib.loads(path.read_text()).get("tolerance_scale") == "element":
            certified = certify(scene_file.read_cases(path)["base"])
            assert (certified.value > 0).all() and (certified.uncertainty <= 2.0**-53 * certified.value).all()
