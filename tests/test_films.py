"""Films in OpenEXR keep every digit, anybody's OpenEXR is read as the standard has it, and a file that is none says so."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest

from lightproof import films

RAMP = np.arange(12, dtype=np.float32).reshape(3, 4) + 1


def save(path: Path, channels: dict[str, np.ndarray], **header: Any) -> Path:
    OpenEXR.File({"type": OpenEXR.scanlineimage, **header}, channels).write(str(path))
    return path


def window(left: int, top: int, right: int, bottom: int) -> tuple[np.ndarray, np.ndarray]:
    return np.array([left, top], np.int32), np.array([right, bottom], np.int32)


def light(path: Path, channel: str = "") -> np.ndarray:
    grid, channels, _ = films.read(path, channel)
    return channels["Y"].reshape(grid)


def test_float64_round_trip(tmp_path):
    """A film of 12 elements comes back to 1e-14, its header word for word, with the version that wrote it."""
    values = np.geomspace(1e-9, 1e9, 12)
    films.write(tmp_path / "a.exr", (3, 4), {"Y": values, "variance": values / 7}, {"seed": "4294967297", "method": "mc-area"})
    grid, channels, header = films.read(tmp_path / "a.exr")
    assert grid == (3, 4) and channels.keys() == {"Y", "variance"}
    np.testing.assert_allclose(channels["Y"], values, rtol=1e-14)
    np.testing.assert_allclose(channels["variance"], values / 7, rtol=1e-7)
    assert header["seed"] == "4294967297" and header["method"] == "mc-area" and header["lightproof"]
    assert not list(tmp_path.glob("*.partial"))


def test_values_that_no_float32_holds_survive_as_what_they_are(tmp_path):
    """NaN and infinity are the judge's business: the file keeps them."""
    films.write(tmp_path / "a.exr", (1, 3), {"Y": np.array([np.nan, np.inf, 0.1])}, {})
    _, channels, _ = films.read(tmp_path / "a.exr")
    assert np.isnan(channels["Y"][0]) and np.isinf(channels["Y"][1])


@pytest.mark.parametrize("names", ["R G B", "Y", "ViewLayer.Combined.R ViewLayer.Combined.G ViewLayer.Combined.B"])
def test_layers(tmp_path, names):
    """The light is found under the names that renderers give it, beside depth and normals; of colours it is the mean."""
    others = {"Z": 9 + RAMP, **{f"ViewLayer.Normal.{axis}": RAMP for axis in "XYZ"}}
    path = save(tmp_path / "a.exr", {name: RAMP * weight for weight, name in enumerate(names.split(), 1)} | others)
    np.testing.assert_allclose(light(path), RAMP * np.mean(range(1, len(names.split()) + 1)), rtol=1e-6)
    np.testing.assert_allclose(light(path, "Z"), 9 + RAMP)


def test_which_layer_is_light_must_be_said(tmp_path):
    channels = {f"{layer}.{colour}": RAMP * scale for layer, scale in (("beauty", 1), ("albedo", 2)) for colour in "RGB"}
    path = save(tmp_path / "a.exr", channels)
    np.testing.assert_allclose(light(path, "albedo"), 2 * RAMP)
    np.testing.assert_allclose(light(path, "beauty.G"), RAMP)
    for wrong in ("", "depth"):
        with pytest.raises(films.FilmError, match=r"a\.exr: has no .*albedo\.B, albedo\.G"):
            films.read(path, wrong)


def test_tiles_and_parts(tmp_path):
    """Tiles are put together; of several parts each is a layer."""
    picture = np.random.default_rng(1).random((70, 45), np.float32)
    tiled = {"type": OpenEXR.tiledimage, "tiles": OpenEXR.TileDescription()}
    np.testing.assert_array_equal(light(save(tmp_path / "tiled.exr", {"Y": picture}, **tiled)), picture)
    parts = [OpenEXR.Part({"name": name, "type": OpenEXR.scanlineimage}, {channel: RAMP * scale})
             for name, channel, scale in (("depth", "Z", 1), ("beauty", "Y", 2))]
    OpenEXR.File(parts).write(str(tmp_path / "parts.exr"))
    np.testing.assert_array_equal(light(tmp_path / "parts.exr"), 2 * RAMP)
    np.testing.assert_array_equal(light(tmp_path / "parts.exr", "depth.Z"), RAMP)


def test_the_picture_is_what_the_display_window_shows(tmp_path):
    """A data window that reaches one column over the left edge and misses the first row: cropped there, black here."""
    path = save(tmp_path / "a.exr", {"Y": RAMP}, dataWindow=window(9, 21, 12, 23), displayWindow=window(10, 20, 13, 23))
    expected = np.zeros((4, 4))
    expected[1:, :3] = RAMP[:, 1:]
    np.testing.assert_array_equal(light(path), expected)
    save(path, {"Y": RAMP}, dataWindow=window(0, 0, 3, 2), displayWindow=window(10, 20, 13, 23))
    with pytest.raises(films.FilmError, match="shows nothing"):
        films.read(path)


def test_half_floats_are_good_to_half_a_step(tmp_path):
    """1 + 2^-11 lies half way between two halves: the file is off by all of what it declares, 2^-11."""
    exact = np.array([[1 + 2**-11, 1000.3, 1e-5]])
    _, channels, _ = films.read(save(tmp_path / "a.exr", {"Y": exact.astype(np.float16)}))
    error, half_step = np.abs(channels["Y"] - exact.ravel()), channels["quantization"]
    assert error[0] == half_step[0] == 2**-11
    assert (error <= half_step).all() and half_step[1] == 0.25 and half_step[2] == 2**-25


def test_truncated_foreign_and_missing_files(tmp_path, capfd):
    """Every way of being no picture has a message with the file's name, and the library says nothing besides."""
    films.write(tmp_path / "whole.exr", (64, 64), {"Y": np.random.default_rng(1).random(4096)}, {})
    data = (tmp_path / "whole.exr").read_bytes()
    broken = {"half": data[: len(data) // 2], "last": data[:-1], "head": data[:100], "text": b"no image", "empty": b""}
    for name, content in broken.items():
        (tmp_path / f"{name}.exr").write_bytes(content)
        with pytest.raises(films.FilmError, match=rf"{name}\.exr.*write it again"):
            films.read(tmp_path / f"{name}.exr")
    with pytest.raises(films.FilmError, match="no such file"):
        films.read(tmp_path / "none.exr")
    deep = np.empty((1, 1), object)
    deep[0, 0] = np.ones(2, np.float32)
    with pytest.raises(films.FilmError, match="flatten it"):
        films.read(save(tmp_path / "deep.exr", {"Y": deep}, type=OpenEXR.deepscanline, compression=OpenEXR.ZIPS_COMPRESSION))
    with pytest.raises(films.FilmError, match="whole numbers"):
        films.read(save(tmp_path / "ids.exr", {"Y": RAMP.astype(np.uint32)}))
    assert capfd.readouterr() == ("", "")


def test_a_part_that_is_cut_off_is_missed(tmp_path):
    parts = [OpenEXR.Part({"name": name, "type": OpenEXR.scanlineimage}, {"Y": RAMP}) for name in ("a", "b")]
    OpenEXR.File(parts).write(str(tmp_path / "a.exr"))
    (tmp_path / "a.exr").write_bytes((tmp_path / "a.exr").read_bytes()[:-1])
    with pytest.raises(films.FilmError, match="1 of 2 parts are missing"):
        films.read(tmp_path / "a.exr", "a.Y")


@pytest.mark.parametrize("name", ["dataWindow", "displayWindow"])
def test_a_header_that_claims_too_much_is_not_followed(tmp_path, name):
    path = save(tmp_path / "a.exr", {"Y": RAMP})
    data, label = path.read_bytes(), name.encode() + b"\0box2i\0"
    here = data.index(label) + len(label) + 4
    path.write_bytes(data[:here] + np.array([0, 0, 99_999, 99_999], "<i4").tobytes() + data[here + 16:])
    with pytest.raises(films.FilmError, match=rf"claims 100000 x 100000 pixels \({name}\)"):
        films.read(path)


def test_tiles_of_any_size_are_not_followed(tmp_path):
    path = save(tmp_path / "a.exr", {"Y": RAMP}, type=OpenEXR.tiledimage, tiles=OpenEXR.TileDescription())
    data, label = path.read_bytes(), b"tiles\0tiledesc\0"
    here = data.index(label) + len(label) + 4
    path.write_bytes(data[:here] + np.array([1 << 16, 1 << 16], "<u4").tobytes() + data[here + 8:])
    with pytest.raises(films.FilmError, match=r"claims 65536 x 65536 pixels \(tiles\)"):
        films.read(path)
