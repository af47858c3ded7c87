"""Scene files: what is read is what was written, and every broken file says what, where and what would be right."""

from __future__ import annotations

import json
import math
import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lightproof import scene_file, suite
from lightproof.checked import SceneError
from lightproof.scene import AreaLight, Environment, OvercastSky, SunDisc

BOX = """
title = "A lamp"
max_bounces = 0
tolerance = 0.005
[[light]]
id = "lamp"
kind = "area"
shape = { type = "polygon", vertices = [[-1, -1, 1], [-1, 1, 1], [1, 1, 1], [1, -1, 1]] }
radiance = 2.04
[[surface]]
id = "block"
shape = { type = "sphere", center = [0, 0, 0.5], radius = 0.1 }
reflectance = 0.3
[film]
kind = "plane"
quantity = "irradiance"
origin = [-1, -1, 0]
u = [2, 0, 0]
v = [0, 2, 0]
resolution = [4, 3]
"""


def read(tmp_path, text, name="box.toml"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return scene_file.read_cases(path)


def test_reads_numbers_as_the_binary64_they_parse_to(tmp_path):
    scene = read(tmp_path, BOX)["base"]
    assert scene.lights[0] == AreaLight("lamp", scene.lights[0].shape, 2.04)
    assert scene.film.grid == (3, 4) and scene.size == 12
    assert scene.film.normal.tolist() == [0, 0, 1]
    assert scene.lights[0].shape.normal.tolist() == [0, 0, -1]


@pytest.mark.parametrize("scene", suite.default().scenes(), ids=lambda scene: scene.name)
def test_every_scene_survives_json_with_its_digest(scene):
    """A worker gets the scene as JSON and must see the same one."""
    again = scene_file.from_table(json.loads(json.dumps(scene.to_table())), scene.id, scene.case)
    assert again == scene and again.digest == scene.digest


def test_digest_covers_the_light_and_not_the_title(tmp_path):
    base = read(tmp_path, BOX)["base"]
    assert read(tmp_path, BOX.replace("A lamp", "B lamp").replace("0.005", "0.1"))["base"].digest == base.digest
    assert read(tmp_path, BOX.replace("2.04", "2.0400000000000005"))["base"].digest != base.digest
    assert read(tmp_path, BOX.replace("max_bounces = 0", "max_bounces = 1"))["base"].digest != base.digest


def test_cases_replace_fields_by_path(tmp_path):
    cases = read(tmp_path, BOX + '[cases.high]\n"light.lamp.radiance" = 1e6\n"film.origin" = [0, 0, 3]\n'
                 '[cases.big]\n"surface.block.shape.radius" = 0.25\nmax_bounces = "all"\n')
    assert cases["high"].lights[0].radiance == 1e6 and cases["high"].film.origin == (0, 0, 3)
    assert cases["big"].surfaces[0].shape.radius == 0.25 and cases["big"].max_bounces == "all"
    assert cases["base"].lights[0].radiance == 2.04


@pytest.mark.parametrize(("light", "kind"), [
    ('kind = "environment"\nradiance = 1.5', Environment),
    ('kind = "environment"\nradiance = 1.5\nhalf_angle = 3\ndirection = [0, 0, -1]', SunDisc),
    ('kind = "environment"\nsky = "cie-overcast"\nzenith_radiance = 2', OvercastSky),
])
def test_environments_are_told_apart_by_their_fields(tmp_path, light, kind):
    start, end = BOX.index('kind = "area"'), BOX.index("[[surface]]")
    text = f"{BOX[:start]}{light}\n{BOX[end:]}"
    assert isinstance(read(tmp_path, text)["base"].lights[0], kind)


BROKEN = {
    "unknown key": ("radiance = 2.04", "radiance = 2.04\npower = 3", ["light.lamp.power", "not a field"]),
    "missing key": ("radiance = 2.04", "", ["light.lamp.radiance", "missing"]),
    "wrong type": ("radiance = 2.04", 'radiance = "bright"', ["light.lamp.radiance", "not a number"]),
    "boolean": ("radiance = 2.04", "radiance = true", ["light.lamp.radiance", "not a number"]),
    "not a number": ("radiance = 2.04", "radiance = nan", ["light.lamp.radiance", "not finite"]),
    "infinite": ("radiance = 2.04", "radiance = inf", ["light.lamp.radiance", "not finite"]),
    "huge integer": ("radiance = 2.04", "radiance = 1" + "0" * 400, ["light.lamp.radiance", "not finite"]),
    "negative radiance": ("radiance = 2.04", "radiance = -1", ["light.lamp.radiance", "at least 0"]),
    "reflectance above 1": ("reflectance = 0.3", "reflectance = 1.1", ["surface.block.reflectance", "at most 1"]),
    "no radius": ("radius = 0.1", "radius = 0", ["surface.block.shape.radius", "at least 1e-150"]),
    "unknown shape": ('type = "sphere"', 'type = "teapot"', ["surface.block.shape.type", "'sphere'"]),
    "unknown light": ('kind = "area"', 'kind = "laser"', ["light.lamp.kind", "'environment'"]),
    "two dimensions": ("center = [0, 0, 0.5]", "center = [0, 0]", ["surface.block.shape.center", "[x, y, z]"]),
    "bent polygon": ("[1, 1, 1], [1, -1, 1]", "[1, 1, 1.3], [1, -1, 1]", ["light.lamp.shape.vertices", "off the plane"]),
    "crossed polygon": ("[-1, 1, 1], [1, 1, 1]", "[1, 1, 1], [-1, 1, 1]", ["light.lamp.shape.vertices", "area"]),
    "bow tie": ("[[-1, -1, 1], [-1, 1, 1], [1, 1, 1], [1, -1, 1]]", "[[0, 0, 1], [0, 3, 1], [2, 0, 1], [2, 1, 1]]",
                ["light.lamp.shape.vertices", "cross"]),
    "astronomical": ("[-1, 1, 1]", "[-1e151, 1, 1]", ["light.lamp.shape.vertices[1]", "from -1e+150"]),
    "degenerate frame": ("v = [0, 2, 0]", "v = [4, 0, 0]", ["film.v", "parallel"]),
    "zero direction": ("v = [0, 2, 0]", "v = [0, 0, 0]", ["film.v", "no direction"]),
    "no pixels": ("resolution = [4, 3]", "resolution = [0, 3]", ["film.resolution[0]", "from 1"]),
    "wrong quantity": ('quantity = "irradiance"', 'quantity = "lux"', ["film.quantity", "'irradiance'"]),
    "inside of a polygon": ("reflectance = 0.3", 'reflectance = 0.3\nside = "sideways"', ["surface.block.side", "'inside'"]),
    "fractional bounces": ("max_bounces = 0", "max_bounces = 1.5", ["max_bounces", "whole number"]),
    "no tolerance": ("tolerance = 0.005", "tolerance = 0", ["tolerance", "greater than 0"]),
    "same id twice": ('id = "block"', 'id = "lamp"', ["'lamp'", "ids must differ"]),
    "bad id": ('id = "block"', 'id = "<b>Block"', ["surface", "hyphens"]),
    "no film": ("[film]", "[[film]]", ["film", "not a table"]),
    "not TOML": ("[film]", "[film", ["not TOML"]),
    "case called base": ("[film]", '[cases.base]\nmax_bounces = 3\n[film]', ["cases.base", "another name"]),
    "unknown case path": ("[film]", '[cases.x]\n"light.lump.radiance" = 3\n[film]', ["cases.x", "lump"]),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_files_name_file_field_and_remedy(tmp_path, name):
    old, new, expected = BROKEN[name]
    assert old in BOX
    with pytest.raises(SceneError) as caught:
        read(tmp_path, BOX.replace(old, new))
    message = str(caught.value)
    assert message.startswith(str(tmp_path / "box.toml"))
    for part in expected:
        assert part in message


def test_a_closed_white_enclosure_with_all_bounces_is_refused(tmp_path):
    text = BOX.replace("reflectance = 0.3", 'reflectance = 1\nside = "inside"').replace("max_bounces = 0", 'max_bounces = "all"')
    with pytest.raises(SceneError, match="never loses light"):
        read(tmp_path, text)


WALLS = [[[0, 0, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1]], [[1, 0, 0], [1, 0, 1], [1, 1, 1], [1, 1, 0]],
         [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]], [[0, 1, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1]],
         [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 0, 1], [0, 1, 1], [1, 1, 1], [1, 0, 1]]]


@pytest.mark.parametrize(("reflectance", "turned", "refused"), [(1, False, True), (0.9, False, False), (1, True, False)])
def test_a_white_room_is_refused_and_a_grey_one_or_a_white_box_is_not(reflectance, turned, refused):
    """A unit cube of six polygons: light never leaves it where all are white and face inward."""
    surfaces = [{"id": f"wall-{index}", "reflectance": reflectance,
                 "shape": {"type": "polygon", "vertices": wall[::-1 if turned else 1]}}
                for index, wall in enumerate(WALLS)]
    table = tomllib.loads(BOX) | {"max_bounces": "all", "surface": surfaces}
    if refused:
        with pytest.raises(SceneError, match="never loses light"):
            scene_file.from_table(table, "room")
    else:
        scene_file.from_table(table, "room")


def test_a_scene_in_which_nothing_shines_is_refused():
    table = tomllib.loads(BOX)
    del table["light"]
    with pytest.raises(SceneError, match="nothing shines"):
        scene_file.from_table(table, "dark")
    table["surface"][0]["radiance"] = 0.7
    assert scene_file.from_table(table, "glowing").surfaces[0].radiance == 0.7


def test_missing_binary_and_huge_files(tmp_path):
    with pytest.raises(SceneError, match="cannot be read"):
        scene_file.read_cases(tmp_path / "none.toml")
    (tmp_path / "raw.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SceneError, match="not UTF-8"):
        scene_file.read_cases(tmp_path / "raw.toml")
    (tmp_path / "huge.toml").write_bytes(b"#" * (scene_file.MAX_BYTES + 1))
    with pytest.raises(SceneError, match="larger than"):
        scene_file.read_cases(tmp_path / "huge.toml")


def test_a_file_name_that_is_no_id_is_refused(tmp_path):
    with pytest.raises(SceneError, match="not an id"):
        read(tmp_path, BOX, "My Box.toml")


toml_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=8,
)
paths = st.sampled_from(["title", "tags", "light", "light.lamp.shape", "light.lamp.shape.vertices", "surface.block.shape.center",
                         "film", "film.u", "film.resolution", "max_bounces", "tolerance", "tolerance_scale", "film.x.y"])


@given(paths, toml_values)
def test_any_value_anywhere_is_accepted_or_a_scene_error(path, value):
    """Nothing that parses as TOML or JSON may raise anything but SceneError."""
    table = tomllib.loads(BOX)
    try:
        scene = scene_file.from_table(scene_file._replaced(table, {path: value}), "box")
    except SceneError as error:
        assert str(error).isprintable()
    else:
        assert math.isfinite(scene.tolerance)
