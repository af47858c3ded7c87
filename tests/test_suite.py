"""A suite is any folder with scenes/ and references/."""

from __future__ import annotations

import shutil

import pytest

from lightproof import suite
from lightproof.checked import SceneError
from lightproof.references import ReferenceError

QUICK = {"disk-blocker", "disk-light", "knife-edge", "occluded-square", "off-centre-point-in-sphere", "point-light",
         "sphere-furnace", "sphere-light", "square-light", "square-light-seen", "triangle-light", "white-furnace-plane"}
CATALOGUE = {
    "direct": "square-light triangle-light l-shaped-light disk-light sphere-light tube-light two-lights point-light beam sun-disc"
              " overcast-sky roof-opening square-light-seen lamp-at-distance",
    "shadow": "occluded-square knife-edge two-blockers triangle-blocker l-shaped-blocker disk-blocker sphere-blocker"
              " point-light-shadow umbra contact-shadow picket-fence tilted-blocker sky-with-wall soft-shadow-picture",
    "furnace": "white-furnace-plane white-furnace-sphere sphere-furnace cube-furnace flux-closure",
    "interreflection": "centred-point-in-sphere off-centre-point-in-sphere two-zone-sphere emitting-cap concentric-spheres"
                       " cube-room lit-floor-to-wall",
    "solid-angle": "solid-angle-triangle solid-angle-rectangle solid-angle-disk solid-angle-cap solid-angle-whole-sphere"
                   " solid-angle-overlap",
    "hard": "hard-distance hard-grazing hard-translation hard-aspect hard-approach hard-in-plane hard-touching-edge"
            " hard-tiny-solid-angle hard-through-vertex hard-degenerate-light hard-reflectance",
}


@pytest.mark.parametrize("group", CATALOGUE)
def test_the_default_suite_has_the_whole_catalogue(group):
    """Every scene of the group is there and carries its tag."""
    home = suite.default()
    for scene_id in CATALOGUE[group].split():
        assert group in home.scene(scene_id).tags, scene_id


def test_the_quick_scenes_are_those_of_the_main_job():
    home = suite.default()
    assert {scene_id for scene_id in home.ids if "quick" in home.scene(scene_id).tags} == QUICK


def test_no_scene_uses_ones_that_hide_cancelled_factors():
    """Radiance and intensity are awkward numbers, so that a factor applied twice or not at all shows."""
    for scene in suite.default().scenes():
        values = [value for item in (*scene.lights, *scene.surfaces) for key, value in item.to_table().items()
                  if key in ("radiance", "intensity", "irradiance", "zenith_radiance")]
        assert any(len(f"{value:e}".partition("e")[0].rstrip("0")) > len("2.") for value in values), scene.name


@pytest.mark.parametrize("scene", suite.default().scenes(), ids=lambda scene: scene.name)
def test_every_scene_says_what_it_tests_and_has_a_reference_far_under_its_tolerance(scene):
    reference = suite.default().reference(scene)
    assert scene.tests and scene.tags
    scales = {"max": abs(reference.value).max(), "element": abs(reference.value)}
    scale = scales.get(scene.tolerance_scale, scene.tolerance_scale)
    assert (reference.uncertainty <= scene.tolerance * scale / 1000).all()


def test_users_files_are_found_beside_their_references(tmp_path):
    root = suite.default().root
    (tmp_path / "scenes").mkdir()
    shutil.copy(root / "scenes" / "point-light.toml", tmp_path / "scenes" / "mine.toml")
    scene, home = suite.find(f"{tmp_path}/scenes/mine.toml:near", suite.default())
    assert (scene.id, scene.case, home.root) == ("mine", "near", tmp_path)
    with pytest.raises(ReferenceError, match="certify"):
        home.reference(scene)


def test_unknown_scenes_cases_and_folders_say_what_there_is(tmp_path):
    with pytest.raises(SceneError, match="square-light"):
        suite.default().scene("round-light")
    with pytest.raises(SceneError, match="near"):
        suite.default().scene("square-light:nearer")
    with pytest.raises(SceneError, match="no suite"):
        _ = suite.Suite(tmp_path).ids


def test_a_stale_reference_is_refused(tmp_path):
    """A scene that was edited after its reference was made must not be judged by it."""
    root = suite.default().root
    for folder in ("scenes", "references"):
        (tmp_path / folder).mkdir()
        for path in (root / folder).glob("point-light.*"):
            shutil.copy(path, tmp_path / folder)
    file = tmp_path / "scenes" / "point-light.toml"
    file.write_text(file.read_text().replace("2.9", "2.91"))
    with pytest.raises(ReferenceError, match="another version"):
        suite.Suite(tmp_path).reference(suite.Suite(tmp_path).scene("point-light"))


@pytest.mark.parametrize(("name", "old", "new"), [
    ("point-light.toml", 'engine = "certify/direct"', ""), ("point-light.toml", "formula", "formulas"),
    ("point-light.toml", "[cases.base]", "[cases.base.more]"), ("point-light.toml", "[cases.base]", "[cases.base"),
    ("point-light.csv", "base,7,", "base,8,"), ("point-light.csv", "base,7,", "base,7,bright"),
    ("point-light.csv", "base,7,", '"base,7,'), ("point-light.csv", "base,7,", "base,7,nan"),
    ("point-light.csv", "element", "number"),
])  # fmt: skip
def test_a_broken_reference_is_named(tmp_path, name, old, new):
    """A field renamed, lost or nested too deep, an element twice, a word for a number: the file is named, and what mends it."""
    root = suite.default().root
    shutil.copytree(root / "references", tmp_path / "references")
    broken = tmp_path / "references" / name
    assert old in broken.read_text()
    broken.write_text(broken.read_text().replace(old, new, 1))
    with pytest.raises(ReferenceError, match=rf"{name}: "):
        suite.Suite(tmp_path).reference(suite.default().scene("point-light"))
