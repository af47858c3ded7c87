"""Radiance: its units against closed forms, its replicates against each other, and what its configurations are off by."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import one_process
import pytest
import test_units
from one_process import Shot

from lightproof import exporting, scene_file, suite
from lightproof.renderers import importing
from lightproof.renderers.radiance_transport import transport_of
from lightproof.renderers.registry import METHODS

SUITE = suite.default()
BASE = [scene for name in SUITE.ids if "quick" in (scene := SUITE.scene(name)).tags]
UP = [0, 0, 1]


def scene(table: dict[str, Any], name: str = "known") -> Any:
    return scene_file.from_table(table, name)


def at(light: dict[str, Any], normal: list[float], surfaces: Any = ()) -> dict[str, Any]:
    film = {"kind": "points", "quantity": "irradiance", "positions": [[0.3, -0.2, 0.1]], "normals": [normal]}
    return test_units.described([light], surfaces, film, 0)


def shot(table: dict[str, Any], points: int = 1 << 18) -> Shot:
    """A lamp's irradiance at a point has a standard deviation about as large as itself; everything else is steadier."""
    return Shot(scene(table), points if table["film"]["kind"] == "points" else 1024)


@pytest.fixture(scope="module")
def films(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The films of the known lights, from one process."""
    shots = [shot(table, 1 << 16) for table, _ in test_units.KNOWN.values()]
    answers = one_process.render("radiance", shots, tmp_path_factory.mktemp("radiance"))
    return dict(zip(test_units.KNOWN, answers, strict=True))


@pytest.mark.parametrize("name", test_units.KNOWN)
def test_known_light(films: dict[str, Any], name: str) -> None:
    """Radiance does every light of tests/test_units.py; a factor of pi, 4/pi or 179 is far more than the one per cent."""
    for element, value in zip(films[name]["film"], test_units.KNOWN[name][1], strict=True):
        if value is not None:
            assert element == pytest.approx(value, rel=0.01, abs=1e-12)


def test_skies_and_suns(tmp_path: Path) -> None:
    """On a level plane: an overcast sky E = 7/9 pi L of its zenith; a sun of half angle a, 40 degrees from the zenith,
    E = pi L sin^2(a) cos(40)."""
    travel = [float(np.sin(np.radians(40))), 0, -float(np.cos(np.radians(40)))]
    sun = {"kind": "environment", "radiance": 31.0, "direction": travel, "half_angle": 5}
    sky = {"kind": "environment", "sky": "cie-overcast", "zenith_radiance": 1.37}
    overcast, sunny = one_process.render("radiance", [shot(at(sky, UP)), shot(at(sun, UP))], tmp_path)
    assert overcast["film"] == pytest.approx([np.pi * 1.37 * 7 / 9], rel=0.01)
    assert sunny["film"] == pytest.approx([np.pi * 31 * np.sin(np.radians(5)) ** 2 * np.cos(np.radians(40))], rel=0.01)


@pytest.mark.parametrize(("facing", "expected"), [(1, 0.37 * 2.9 / (np.pi * 1.2**2)), (-1, 0.0)])
def test_surfaces_reflect_on_their_front(facing: int, expected: float, tmp_path: Path) -> None:
    """A floor of reflectance 0.37 under a bulb of 2.9 W/sr at 1.2 m, seen from above: L = rho I / (pi h^2) right under it, and
    nothing where the floor faces down."""
    corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]][::facing]
    floor = {"id": "floor", "reflectance": 0.37, "shape": {"type": "polygon", "vertices": corners}}
    film = {"kind": "camera", "quantity": "radiance", "projection": "orthographic", "origin": [0, 0, 2], "target": [0, 0, 0],
            "up": [0, 1, 0], "width": 1e-3, "resolution": [1, 1]}
    bulb = {"kind": "point", "position": [0, 0, 1.2], "intensity": 2.9}
    (answer,) = one_process.render("radiance", [Shot(scene(test_units.described([bulb], [floor], film, 1)), 64)], tmp_path)
    assert answer["film"] == pytest.approx([expected], rel=1e-3, abs=1e-12)


def test_a_lamp_hides_what_glows_behind_it(tmp_path: Path) -> None:
    """The two disks of tests/test_adapters.py, each of which would need an aperture: Radiance finds both by looking around."""
    near, far = ({"type": "disk", "center": [0.3, -0.2, h + 0.1], "normal": [0, 0, -1], "radius": r}
                 for h, r in ((0.8, 0.3), (1.6, 0.9)))
    table = at(test_units.area(near, 3.7), UP, [{"id": "glow", "shape": far, "reflectance": 0, "radiance": 1.9}])
    (answer,) = one_process.render("radiance", [shot(table)], tmp_path)
    exact = np.pi * ((3.7 - 1.9) * 0.3**2 / (0.3**2 + 0.8**2) + 1.9 * 0.9**2 / (0.9**2 + 1.6**2))
    assert answer["film"] == pytest.approx([exact], rel=0.01)


def test_base_scenes(tmp_path: Path) -> None:
    """Every quick scene at 256 samples: the film's mean within 1 per cent of the reference's, the elements together within 5
    per cent of the film's largest. This is a check of the adapter; the verdict on the renderer is the harness's."""
    for base, answer in zip(BASE, one_process.render("radiance", [Shot(base, 256) for base in BASE], tmp_path), strict=True):
        exact, film = SUITE.reference(base).value, np.array(answer["film"])
        assert film.mean() == pytest.approx(exact.mean(), rel=0.01), base.name
        assert np.sqrt(np.mean((film - exact) ** 2)) < 0.05 * exact.max(), base.name


def test_samples_are_those_spent(tmp_path: Path) -> None:
    """occluded-square: 64 parts of the lamp from each point, so that 100 samples asked for are 2 points; point-light: 100."""
    scenes = [SUITE.scene("occluded-square"), SUITE.scene("point-light")]
    answers = one_process.render("radiance", [Shot(each, 100) for each in scenes], tmp_path)
    assert [answer["samples"] for answer in answers] == [128, 100]


def test_a_ball_above_the_horizon_takes_one_ray(tmp_path: Path) -> None:
    """sphere-light: what is left of the noise comes from where in its element a point lies; a ball that the horizon cuts is
    sampled all over."""
    whole, cut = (SUITE.scene(name) for name in ("sphere-light", "sphere-light:horizon"))
    assert transport_of(whole).middle and not transport_of(cut).middle
    (answer,) = one_process.render("radiance", [Shot(whole, 256)], tmp_path)
    assert np.array(answer["film"]) == pytest.approx(SUITE.reference(whole).value, rel=1e-3)


@pytest.mark.parametrize("name", ["disk-light:axis", "off-centre-point-in-sphere:irradiance"])
def test_replicates_are_independent(name: str, tmp_path: Path) -> None:
    """Points, which no generator of ours moves, of a scene without and of one with reflections, prepared and rendered three
    times at once: programs that began in the same second, or at the same place of a sequence, would give the same film."""
    answers = one_process.render("radiance", [Shot(SUITE.scene(name), 64, seed) for seed in range(3)], tmp_path)
    assert len(np.unique([answer["film"] for answer in answers], axis=0)) == 3


def test_processes_do_not_share_a_stream() -> None:
    """Two programs trace the same ray 512 times each, to paths in a sphere: other paths."""
    _run("""
import time
import numpy as np
from lightproof import suite
from lightproof.renderers.radiance import Radiance
method = Radiance("radiance", 2)
method.open()
method.prepare(suite.default().scene("off-centre-point-in-sphere:irradiance"))
time.sleep(1.1)
first, second = np.split(method.rtraces.trace(np.tile([2, -0.2, 0.4, -1, 0, 0], (1024, 1))), 2)
assert len(method.rtraces._running) == 2
assert len(set(first)) > 400 and len(set(first) & set(second)) < 20
""")


@pytest.mark.parametrize("name", ["solid-angle-disk", "hard-reflectance:bulb", "tube-light:points", "lit-floor-to-wall"])
def test_what_is_unsupported_is_known_without_the_renderer(name: str) -> None:
    """The reasons come out of a process in which Radiance cannot be imported; what it can do has none."""
    reasons = {"solid-angle-disk": "Radiance gives no solid angles",
               "hard-reflectance:bulb": "6,214,605 reflections matter here, and at most 1,400 are followed",
               "tube-light:points": "Radiance is shown a round lamp through a box around it, and 'film' reaches into that box",
               "lit-floor-to-wall": None}
    _run(f"""
import sys
sys.modules["pyradiance"] = None
from lightproof import suite
from lightproof.renderers.radiance import Radiance
assert Radiance("radiance", 1).unsupported(suite.default().scene({name!r})) == {reasons[name]!r}
""")


def test_a_missing_package_is_named_with_its_command() -> None:
    """Without pyradiance: Unavailable, and the pip command of the extra."""
    _run("""
import sys
sys.modules["pyradiance"] = None
from lightproof.method import Unavailable
from lightproof.renderers.radiance import Radiance
try:
    Radiance("radiance", 1).open()
except Unavailable as missing:
    assert str(missing) == "pyradiance is not installed: pip install 'lightproof[radiance]'"
else:
    raise AssertionError
""")


def test_its_own_lamps_are_off_as_the_caveat_says(tmp_path: Path) -> None:
    """triangle-light with Radiance's own polygon, which it samples as a square: 4 per cent too dark on the whole; the same
    lamp through an aperture is right to half a per cent."""
    asked = [Shot(SUITE.scene("triangle-light"), 4096)]
    exact = SUITE.reference(asked[0].scene).value.mean()
    (native,) = one_process.render("radiance/native-lamps", asked, tmp_path)
    (even,) = one_process.render("radiance", asked, tmp_path)
    assert np.mean(native["film"]) == pytest.approx(0.962 * exact, rel=0.005)
    assert np.mean(even["film"]) == pytest.approx(exact, rel=0.005)


def test_its_own_order_of_random_numbers_is_off_as_the_caveat_says(tmp_path: Path) -> None:
    """A tilted plane under half a sky, at 4,096 directions a cell: cells are off by 4 per cent, every time the same; with
    random directions by less than one."""
    asked = [Shot(SUITE.scene("white-furnace-plane:tilted"), 4096, seed) for seed in (1, 2)]
    exact = SUITE.reference(asked[0].scene).value
    answers = one_process.render("radiance/quasi-random", asked, tmp_path)
    answers += one_process.render("radiance", asked[:1], tmp_path)
    own, again, random = (np.array(answer["film"]) / exact - 1 for answer in answers)
    assert own.std() > 0.03 and (own == again).all()
    assert random.std() < 0.01


def test_small_things_are_made_large(tmp_path: Path) -> None:
    """contact-shadow:penumbra, a film of 0.2 mm: its mean within half a per cent, though Radiance's own lengths are absolute
    and blur a shadow's edge by a thousandth of a millimetre."""
    asked = SUITE.scene("contact-shadow:penumbra")
    (answer,) = one_process.render("radiance", [Shot(asked, 1024)], tmp_path)
    assert np.mean(answer["film"]) == pytest.approx(SUITE.reference(asked).value.mean(), rel=0.005)


def test_a_lamp_seen_flatly_is_whole(tmp_path: Path) -> None:
    """flux-closure:disk-south, a wall that sees the disk nearly from the side: within half a per cent. Of a disk in 64 parts
    Radiance leaves out those that it sees at a cosine below 0.0064, and is 0.8 per cent too dark."""
    asked = SUITE.scene("flux-closure:disk-south")
    (answer,) = one_process.render("radiance", [Shot(asked, 1 << 20)], tmp_path)
    assert np.mean(answer["film"]) == pytest.approx(SUITE.reference(asked).value.mean(), rel=0.005)


@pytest.mark.parametrize("name", ["disk-light", "square-light-seen", "sky-with-wall"])
def test_an_exported_scene_is_rendered_by_its_own_commands(name: str, tmp_path: Path) -> None:
    """What the .rad says to type gives the adapter's film: the mean within 1 per cent, elements within 3 of the largest.
    A picture's numbers have 8 bits."""
    asked = SUITE.scene(name)
    exporting.write(asked, "radiance", tmp_path / f"{name}.rad")
    (answer,) = one_process.render("radiance", [Shot(asked, 4096)], tmp_path)
    commands = re.findall("# Render: (.*)", (tmp_path / f"{name}.rad").read_text())
    numbers = _typed([*commands, f"pvalue -h -H -d -o {name}.hdr"], tmp_path)
    radiance = np.array(numbers.split(), float).reshape(*asked.film.grid, 3)[:, :, 0]
    ours, theirs = exporting.view(asked).elements(radiance), np.array(answer["film"])
    assert ours.mean() == pytest.approx(theirs.mean(), rel=0.01)
    assert np.sqrt(np.mean((ours - theirs) ** 2)) < 0.03 * theirs.max()


def _typed(commands: list[str], folder: Path) -> str:
    """What the last of some commands prints, with Radiance's programs at hand."""
    home = Path(importing.renderer("pyradiance", "radiance").__file__).parent
    environment = {**os.environ, "PATH": f"{home / 'bin'}:{os.environ['PATH']}", "RAYPATH": f".:{home / 'lib'}"}
    done = subprocess.run(["sh", "-c", " && ".join(commands)], cwd=folder, env=environment, stdout=subprocess.PIPE, text=True,
                          timeout=100, check=True)
    return done.stdout


def test_configurations() -> None:
    """The best one runs by default, the others nightly; all in one process."""
    names = [name for name in METHODS if name.startswith("radiance")]
    assert [name for name in names if not METHODS[name].nightly] == ["radiance"]
    assert {METHODS[name].worker for name in names} == {"radiance"}


def _run(code: str) -> None:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    if "Unavailable: pyradiance" in done.stderr:
        pytest.skip(done.stderr.strip().splitlines()[-1])
    assert done.returncode == 0, done.stderr[-2000:]
