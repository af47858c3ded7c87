"""Somebody's picture is judged by what it holds, and what cannot be read or does not fit is named.

The picture is made up: of point-light, whose exact light is E = I cos / r2, seen as the radiance L = E / pi of the receiver
that is exported for it, far side on top.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from lightproof import cli, films, grading, scene_file, suite
from lightproof.films import FilmError
from lightproof.grading import Reading

SUITE = suite.default()
SCENE = SUITE.scene("point-light")
EXACT = SUITE.reference(SCENE).value.reshape(SCENE.film.grid)
PICTURE = EXACT[::-1] / np.pi


def save(path: Path, picture: np.ndarray, kind: type = np.float32, **header: str) -> Path:
    """A grey picture as renderers write it."""
    plane = np.ascontiguousarray(picture, kind)
    OpenEXR.File({"type": OpenEXR.scanlineimage, **header}, dict.fromkeys("RGB", plane)).write(str(path))
    return path


@pytest.fixture
def grade(tmp_path, capsys):
    """`lightproof grade` of pictures of point-light: exit status, output, errors and the folder of the page."""

    def grade(*arguments: object, scene: str = "point-light"):
        out = tmp_path / "grades"
        before = set(out.glob("*"))
        status = cli.main(["grade", *map(str, arguments), *(["--scene", scene] if scene else []), "--out", str(out)])
        printed = capsys.readouterr()
        return status, printed.out, printed.err, next(iter(set(out.glob("*")) - before), None)

    return grade


def test_a_right_picture_passes_and_has_a_page(grade, tmp_path):
    """The picture of the exported camera, to float32: a pass, on the page and in results.csv as in a run's."""
    path = save(tmp_path / "a.exr", PICTURE)
    status, out, _, folder = grade(path, "--quantity", "radiance", "--strict")
    assert status == 0 and "point-light: pass" in out and "judged as it is, noise included" in out
    assert str(folder / "index.html") in out and str(path) in (folder / "results.csv").read_text()
    (row,) = csv.DictReader((folder / "results.csv").open())
    assert (row["method"], row["outcome"], row["seconds_render"]) == ("picture", "pass", "")


def test_a_wrong_picture_fails_with_a_second_one(grade, tmp_path):
    """4 / pi too bright: one picture might be noise, so it is undecided with the likely mistake; two of them fail."""
    path = save(tmp_path / "a.exr", 4 / np.pi * PICTURE)
    status, out, _, _ = grade(path, "--quantity", "radiance")
    assert status == 0 and "undecided" in out and "a factor of 4/pi" in out and "would decide" not in out
    status, out, _, _ = grade(path, "--finer", path, "--quantity", "radiance", "--strict")
    assert status == 1 and "point-light: fail" in out
    status, out, _, _ = grade(path, "--quantity", "radiance", "--scale", np.pi / 4)
    assert "point-light: pass" in out


def test_a_picture_that_is_read_as_the_wrong_quantity_says_so(grade, tmp_path):
    status, out, _, _ = grade(save(tmp_path / "a.exr", PICTURE))
    assert status == 0 and "undecided" in out and "say --quantity radiance" in out


def test_noisy_replicates_are_judged_by_intervals(grade, tmp_path):
    """16 pictures with noise of 2 % a pixel, tolerance 0.5 %: their mean is within 2 % / 4 a pixel, and each tile's interval
    inside where the light is right, 4 % outside where it is 5 % too bright."""
    noise = np.random.default_rng(1).normal(1, 0.004, (32, *PICTURE.shape))
    right = [save(tmp_path / f"r{number}.exr", PICTURE * each) for number, each in enumerate(noise[:16])]
    assert "point-light: pass" in grade(*right, "--quantity", "radiance")[1]
    wrong = [save(tmp_path / f"w{number}.exr", 1.05 * PICTURE * each) for number, each in enumerate(noise)]
    out = grade(*wrong[:16], "--finer", *wrong[16:], "--quantity", "radiance", "--samples", 64)[1]
    assert "point-light: fail" in out and "at two steps" in out


def test_our_own_films_need_no_scene(grade, tmp_path):
    """The header names the scene, and one of another version of it is refused."""
    about = {"scene": SCENE.id, "case": SCENE.case, "digest": SCENE.digest, "quantity": "irradiance", "samples": "64"}
    films.write(tmp_path / "a.exr", SCENE.film.grid, {"Y": EXACT.ravel()}, about)
    assert "point-light: pass" in grade(tmp_path / "a.exr", scene="")[1]
    films.write(tmp_path / "b.exr", SCENE.film.grid, {"Y": EXACT.ravel()}, about | {"digest": "0" * 64})
    assert "another version" in grade(tmp_path / "b.exr", scene="")[2]
    assert "say it with --scene" in grade(save(tmp_path / "c.exr", PICTURE), scene="")[2]
    assert "holds 'irradiance', not radiance" in grade(tmp_path / "a.exr", "--quantity", "radiance")[2]


@pytest.mark.parametrize("samples", ["0", "-4", "9" * 19, "9" * 5000, "many"])
def test_a_header_that_counts_nonsense_counts_nothing(grade, tmp_path, samples):
    """Samples that no picture has are as good as unknown."""
    status, out, _, _ = grade(save(tmp_path / "a.exr", 2 * PICTURE, samples=samples), "--quantity", "radiance")
    assert status == 0 and "undecided" in out and "would decide" not in out


def film(path: Path, reading: Reading, scene=SCENE) -> np.ndarray:
    (result,) = grading.results([[path]], scene, reading)
    return result.film.reshape(scene.film.grid)


def test_what_pixels_are(tmp_path):
    """Irradiance as it is, row for row; radiance of the receiver upside down; a finer picture averaged over its blocks; of a
    receiver where surfaces reflect, the light of reflectance 1/1000."""
    np.testing.assert_allclose(film(save(tmp_path / "a.exr", EXACT), Reading()), EXACT, rtol=1e-6)
    ramp = np.kron(PICTURE, np.ones((3, 3))) * np.tile([0.5, 1, 1.5], PICTURE.shape[1])
    np.testing.assert_allclose(film(save(tmp_path / "b.exr", ramp), Reading("radiance")), EXACT, rtol=1e-6)
    table = SUITE.scene("square-light-seen").to_table()  # a floor that reflects, under a film that looks down
    table["film"] = {"kind": "plane", "quantity": "irradiance", "origin": [0, 0, 2], "u": [0, 1, 0], "v": [1, 0, 0],
                     "resolution": [2, 3]}
    ceiling = scene_file.from_table(table, "ceiling")
    np.testing.assert_allclose(film(save(tmp_path / "c.exr", np.ones((3, 2))), Reading("radiance"), ceiling), np.pi / 1e-3)


def test_half_floats_widen_the_intervals(tmp_path):
    """A part in 2^12 of 1 is lost by rounding; that is what each interval is wider by, in the film's unit."""
    path = save(tmp_path / "a.exr", np.full(SCENE.film.grid, 1.25), np.float16)
    (result,) = grading.results([[path]], SCENE, Reading("radiance", 2.0))
    np.testing.assert_allclose(result.quantization, 2 * np.pi * 2**-11, rtol=1e-12)
    assert "Its format rounds" in result.caveat


def test_channels_that_differ_are_told_of(tmp_path):
    """Red 1.1, green 1 and blue 0.9 times the light: 20 per cent apart. One of them alone is what it is; grey needs no word."""
    planes = {name: np.ascontiguousarray(scale * EXACT, np.float32) for name, scale in zip("RGB", (1.1, 1, 0.9), strict=True)}
    path = tmp_path / "a.exr"
    OpenEXR.File({"type": OpenEXR.scanlineimage}, planes).write(str(path))
    grey = save(tmp_path / "b.exr", EXACT)
    together, red, plain = (grading.results([[each]], SCENE, Reading(channel=name))[0]
                            for each, name in ((path, ""), (path, "R"), (grey, "")))
    assert "R, G and B lie 20 % apart" in together.caveat
    np.testing.assert_allclose(red.film, 1.1 * EXACT.ravel(), rtol=1e-6)
    assert "apart" not in red.caveat + plain.caveat


def test_what_does_not_fit(tmp_path):
    films.write(tmp_path / "b.exr", SCENE.film.grid, {"Y": EXACT.ravel(), "quantization": np.full(EXACT.size, -1.0)}, {})
    with pytest.raises(FilmError, match="no half step"):
        film(tmp_path / "b.exr", Reading())
    for picture, reading, scene, message in (
        (PICTURE[1:], Reading(), SCENE, r"a\.exr: is 16 x 11 pixels; point-light takes 16 x 12"),
        (PICTURE, Reading(channel="depth"), SCENE, r"no channel or lit layer 'depth'.*channels: B, G, R"),
        (PICTURE, Reading("solid_angle"), SCENE, "it cannot be told from solid_angle"),
        (PICTURE, Reading("irradiance"), SUITE.scene("lamp-at-distance"), "is a film of radiance"),
    ):
        with pytest.raises(FilmError, match=message):
            film(save(tmp_path / "a.exr", picture), reading, scene)


def test_bad_arguments(grade, tmp_path):
    path = save(tmp_path / "a.exr", PICTURE)
    assert "did you mean point-light" in grade(path, scene="point-lite")[2]
    assert grade(tmp_path / "none.exr")[0] == 2
    for option in (("--scale", "0"), ("--scale", "nan"), ("--quantity", "luminance")):
        with pytest.raises(SystemExit):
            grade(path, *option)


def test_what_is_no_light_is_an_error(grade, tmp_path):
    """NaN in a pixel: an error that says so, and exit 3."""
    picture = PICTURE.copy()
    picture[3, 4] = np.nan
    status, out, _, _ = grade(save(tmp_path / "a.exr", picture), "--quantity", "radiance")
    assert status == 3 and "1 of the film's 192 elements are not finite" in out
