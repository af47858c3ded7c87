"""An exported scene, rendered in its tool by hand, is the film of the adapter; what no tool here can open says what is due."""

from __future__ import annotations

import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import one_process
import pytest
from one_process import Shot

from lightproof import cli, exporting, geometry, grading, suite
from lightproof.exporting import TOOLS, CannotExport
from lightproof.grading import Reading
from lightproof.method import Unavailable
from lightproof.scene import AreaLight, Scene

SUITE = suite.default()
TEXTS = ("mitsuba", "pbrt", "usd")
REPLICATES = 6
BY_TOOL = {  # adapter, samples, and scenes with every kind of light, shape, camera and companion file
    "mitsuba": ("mitsuba/scalar", 64, ("square-light", "disk-light", "sphere-light", "tube-light", "l-shaped-light", "beam",
                                       "point-light-shadow", "white-furnace-plane:tilted", "roof-opening", "sphere-furnace",
                                       "soft-shadow-picture", "white-furnace-sphere")),
    "blender": ("cycles", 64, ("square-light", "flux-closure", "soft-shadow-picture")),
}


def export(scene: Scene, tool: str, folder: Path) -> Path:
    path = folder / f"{scene.name.replace(':', '-')}{TOOLS[tool].suffix}"
    exporting.write(scene, tool, path)
    return path


@pytest.mark.parametrize("tool", BY_TOOL)
def test_the_tool_itself_renders_what_the_adapter_does(tool, tmp_path):
    """Means over seeds of pictures from the exported file and of the adapter's films: they differ by noise alone, element by
    element and as a whole."""
    method, samples, names = BY_TOOL[tool]
    scenes = [SUITE.scene(name) for name in names]
    shots = [Shot(scene, samples, seed) for scene in scenes for seed in range(1, REPLICATES + 1)]
    answers = one_process.render(method, shots, tmp_path)
    paths = [export(scene, tool, tmp_path) for scene in scenes]
    by_hand = Path(__file__).with_name("by_hand.py")
    subprocess.run([sys.executable, by_hand, tool, tmp_path, str(samples), str(REPLICATES)], check=True, timeout=250)
    for number, (scene, path) in enumerate(zip(scenes, paths, strict=True)):
        pictures = [path.with_name(f"{path.stem}-{seed}.exr") for seed in range(REPLICATES)]
        ours = [result.film for result in grading.results([pictures], scene, Reading("radiance"))]
        theirs = [answer["film"] for answer in answers[number * REPLICATES:][:REPLICATES]]
        assert_alike(np.array(ours), np.array(theirs), scene.name)


def assert_alike(ours: np.ndarray, theirs: np.ndarray, name: str) -> None:
    """Two sets of films (R, n): the rms difference of their means is what their scatter predicts, that of the whole too."""
    scale = np.abs(theirs).max()
    difference = ours.mean(axis=0) - theirs.mean(axis=0)
    noise = np.sqrt((ours.var(axis=0, ddof=1) + theirs.var(axis=0, ddof=1)).mean() / REPLICATES)
    assert np.sqrt((difference**2).mean()) <= 1.5 * noise + 1e-6 * scale, name
    whole = np.hypot(*(films.mean(axis=1).std(ddof=1) for films in (ours, theirs))) / np.sqrt(REPLICATES)
    assert abs(difference.mean()) <= 6 * whole + 1e-6 * scale, name


@pytest.mark.parametrize("tool", TEXTS)
@pytest.mark.parametrize("name", ["square-light", "square-light:tilted", "soft-shadow-picture"])
def test_the_file_says_how_to_judge_its_picture(tool, name, tmp_path):
    """Its comment holds the picture's size and a command that the command line takes, of that scene."""
    path, scene = export(SUITE.scene(name), tool, tmp_path), SUITE.scene(name)
    text = path.read_text(encoding="utf-8")
    assert "Picture: {} x {} pixels".format(*scene.film.resolution) in text
    command = re.search("Judge it with: lightproof (.*)", text)[1].split()
    options = cli.parser().parse_args(command)
    assert options.images == [Path(f"{path.stem}.exr")] and options.scene == scene.name
    assert options.quantity == ("radiance" if scene.film.quantity == "irradiance" else "")


@pytest.mark.parametrize("tool", TEXTS)
def test_what_no_picture_or_tool_can_hold_is_refused(tool, tmp_path):
    for name, reason in (("hard-aspect", "no picture"), ("sun-disc", "'sun'"), ("lit-floor-to-wall", "hide light")):
        with pytest.raises(CannotExport, match=reason):
            export(SUITE.scene(name), tool, tmp_path)
    assert not list(tmp_path.iterdir())


def test_mitsuba_reads_well_formed_xml_with_its_companions(tmp_path):
    """Every file that a scene names is there, and a title cannot end the comment."""
    scene = SUITE.scene("l-shaped-blocker")
    object.__setattr__(scene, "title", "a ?> b -- <c>")
    root = ET.parse(export(scene, "mitsuba", tmp_path)).getroot()
    named = [each.get("value") for each in root.iter("string") if each.get("name") == "filename"]
    assert named and all((tmp_path / name).is_file() for name in named)


def test_exports_for_several_tools_may_share_a_folder(tmp_path):
    """A half sky, which is an image in both: neither overwrites the other's files."""
    scene = SUITE.scene("roof-opening")
    export(scene, "mitsuba", tmp_path)
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    export(scene, "luxcore", tmp_path)
    assert before == {path: path.read_bytes() for path in before} and len(list(tmp_path.iterdir())) > len(before) + 2


def test_pbrt_is_given_radiance_one_to_one(tmp_path):
    """square-light, 2.04 W/(m2 sr): the light's rgb, under the sensor that changes nothing; the film's cells in the window."""
    text = export(SUITE.scene("square-light"), "pbrt", tmp_path).read_text()
    for line in ('AreaLightSource "diffuse" "rgb L" [2.04 2.04 2.04]', '"string sensor" "cie1931" "float iso" [100]',
                 '"bool savefp16" false', '"float screenwindow" [-1.2 1.2 -0.9 0.9]', '"path" "integer maxdepth" [1]'):
        assert line in text
    assert text.count("AttributeBegin") == text.count("AttributeEnd") == 2


def test_pbrt_has_every_kind_of_light_and_shape(tmp_path):
    for name, line in (("beam", '"distant" "rgb L" [3.61'), ("point-light", '"point" "rgb I"'), ("tube-light", '"cylinder"'),
                       ("disk-light", '"disk"'), ("white-furnace-sphere", '"infinite" "rgb L" [1.37'),
                       ("sphere-furnace", "ReverseOrientation")):
        assert line in export(SUITE.scene(name), "pbrt", tmp_path).read_text(), name


@pytest.mark.parametrize(("name", "kind", "intensity"), [
    ("square-light", "RectLight", 2.04), ("disk-light", "DiskLight", 4.3), ("sphere-light", "SphereLight", None),
    ("tube-light", "CylinderLight", 5.3), ("l-shaped-light", "Mesh", None), ("beam", "DistantLight", 3.61),
    ("white-furnace-plane", "DomeLight", 1.37), ("point-light", "SphereLight", None),
])
def test_usd_has_every_kind_of_light(name, kind, intensity, tmp_path):
    """UsdLux: a lamp's intensity is its radiance, a beam's its irradiance; brackets and quotes are in pairs."""
    scene = SUITE.scene(name)
    text = export(scene, "usd", tmp_path).read_text()
    assert text.startswith("#usda 1.0\n") and text.count('"') % 2 == 0
    assert all(text.count(opening) == text.count(closing) for opening, closing in ("{}", "[]", "()"))
    body = text[text.index(f'def {kind} "{scene.lights[0].id}"'):]
    value = float(re.search(r"inputs:intensity = (\S+)", body)[1])
    radiance = getattr(scene.lights[0], "radiance", None) or intensity or scene.lights[0].intensity / np.pi / 1e-6
    assert value == pytest.approx(radiance)


@pytest.mark.parametrize("name", ["square-light:tilted", "disk-light:tilted"])
def test_usd_lamps_are_where_the_light_is(name, tmp_path):
    """UsdLux lamps shine along -z and their transforms act on rows: the fourth is the middle, minus the third the normal."""
    scene = SUITE.scene(name)
    (light,) = (light for light in scene.lights if isinstance(light, AreaLight))
    text = export(scene, "usd", tmp_path).read_text()
    body = text[text.index(f'"{light.id}"'):]
    rows = re.findall(r"\(([^()]*)\)", re.search("xformOp:transform = (.*)", body)[1])
    matrix = np.array([[float(value) for value in row.split(",")] for row in rows])
    middle = np.mean(getattr(light.shape, "vertices", [getattr(light.shape, "center", None)]), axis=0)
    np.testing.assert_allclose(matrix[3], [*middle, 1], atol=1e-12)
    np.testing.assert_allclose(-matrix[2, :3], geometry.unit(light.shape.normal), atol=1e-12)
    assert np.linalg.det(matrix) == pytest.approx(1)


def test_the_command_that_grades_names_what_was_exported(tmp_path):
    """A scene of ours is named by its id; a changed copy, which has another light under the same id, by its file."""
    copy = tmp_path / "scenes/square-light.toml"
    copy.parent.mkdir()
    copy.write_text((SUITE.root / "scenes/square-light.toml").read_text().replace("radiance = 2.04", "radiance = 3"))
    changed, _ = suite.find(f"{copy}:far", SUITE)
    texts = [export(scene, "pbrt", tmp_path).read_text() for scene in (SUITE.scene("square-light:far"), changed)]
    commands = [re.search("lightproof grade .*", text)[0] for text in texts]
    assert commands[0].startswith("lightproof grade square-light-far.exr --scene square-light:far --quantity")
    assert commands[1].startswith("lightproof grade square-light-far.exr --scene square-light.toml:far --quantity")


def test_a_tool_that_is_not_there(monkeypatch, tmp_path):
    """Without Blender's module the .blend cannot be written: the reason is the command that installs it."""
    (tmp_path / "bpy.py").write_text("raise ModuleNotFoundError('bpy')")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with pytest.raises(Unavailable, match=r"pip install 'lightproof\[cycles\]'"):
        export(SUITE.scene("square-light"), "blender", tmp_path)


def test_command_line(tmp_path, capsys):
    assert cli.main(["export", "square-light:far", "--to", "usd", "--out", str(tmp_path)]) == 0
    assert capsys.readouterr().out.strip() == str(tmp_path / "square-light-far.usda")
    assert cli.main(["export", "hard-aspect", "--to", "usd", "--out", str(tmp_path)]) == 3
    assert "no picture" in capsys.readouterr().err
    assert cli.main(["export", "square-light", "--to", "usd", "--out", "/dev/null/x"]) == 2
