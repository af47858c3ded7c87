"""The stored references: admitted by the rules, and what both engines compute when asked again."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib

import numpy as np
import pytest

from lightproof import suite
from lightproof.certify import admission, register, sampling, second_engine, spot_check
from lightproof.reporting import citations
from lightproof.scene import PlaneFilm

HOME = suite.default()
FOLDER = HOME.root / "references"
SCENES = {scene.name: scene for scene in HOME.scenes()}
ROUNDING = 2e-15  # of a film's largest value (of each, where the tolerance is): what binary64 sums may change with library


def sample(scene, reference):
    """A few elements of every kind: the darkest, the brightest, one between."""
    order = np.argsort(reference.value, kind="stable")
    return sorted({int(order[0]), int(order[len(order) // 3]), int(order[-1])})


@pytest.mark.parametrize("name", SCENES)
def test_admitted_by_the_rules(name):
    """Every element's uncertainty is within its limit, and no smaller than the difference between the engines."""
    scene = SCENES[name]
    reference = HOME.reference(scene)
    case = tomllib.loads((FOLDER / f"{scene.id}.toml").read_text(encoding="utf-8"))["cases"][scene.case]
    assert (reference.uncertainty <= admission.limit(scene, reference.value)).all()
    assert (reference.uncertainty >= reference.agreement * np.abs(reference.value).max()).all()
    assert case["second_engine"] == second_engine.find(scene.id, FOLDER).name
    assert case["elements_checked"] >= min(scene.size, sampling.EACH)
    assert case["kind"] == "enclosure" or (case["kind"] == "quadrature" and scene.surfaces and isinstance(scene.film, PlaneFilm))


@pytest.mark.parametrize("name", SCENES)
def test_derived_again(name):
    """The first engine finds the stored values bit for bit (an estimate but for rounding) and is as sure of them, the second
    finds them within the uncertainty and its own rounding."""
    scene = SCENES[name]
    reference = HOME.reference(scene)
    elements = sample(scene, reference)
    assert not [complaint for element in elements if (complaint := spot_check.difference(scene, reference, element))]
    second = second_engine.values(second_engine.find(scene.id, FOLDER), scene, elements)
    value = reference.value[elements]
    scale = np.abs(value) if scene.tolerance_scale == "element" else np.abs(reference.value).max()
    assert (np.abs(second - value) <= reference.uncertainty[elements] + ROUNDING * scale).all()


@pytest.mark.parametrize("scene_id", HOME.ids)
def test_every_source_is_listed(scene_id):
    """Formula, source and citations are there, and the bibliography knows each citation."""
    about = tomllib.loads((FOLDER / f"{scene_id}.toml").read_text(encoding="utf-8"))
    assert about["formula"] and about["source"] and about["citations"]
    assert set(about["citations"]) <= citations.read(FOLDER / "references.bib").keys()


def test_scripts_stand_alone():
    """No second engine imports the first one, or anything of Lightproof."""
    for script in FOLDER.glob("*.py"):
        text = script.read_text(encoding="utf-8")
        assert "import lightproof" not in text and "from lightproof" not in text


def test_a_script_prints_the_base_case():
    """python references/white-furnace-plane.py: pi times the radiance for each of 192 cells."""
    path = FOLDER / "white-furnace-plane.py"
    printed = subprocess.run([sys.executable, str(path)], capture_output=True, text=True, check=True).stdout
    values = json.loads(printed)["base"]
    assert len(values) == 192 and set(values.values()) == {np.pi * 1.37}


@pytest.mark.parametrize("table", register.TABLES)
def test_the_register_is_up_to_date(table):
    """Each table in references/README.md is what the references, or the scripts, say."""
    assert register.TABLES[table](FOLDER) in (FOLDER / "README.md").read_text(encoding="utf-8")


def test_every_script_serves_scenes_that_exist_and_says_how():
    for script in FOLDER.glob("*.py"):
        assert set(second_engine.scenes_of(script)) <= set(HOME.ids), script.name
        assert second_engine.derivation(script), script.name
