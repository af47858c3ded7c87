"""A small run made up without any renderer: three scenes, one of each kind of film, and methods of known faults."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from lightproof import store
from lightproof.films import write as write_film
from lightproof.scene import Scene
from lightproof.scene_file import from_table
from lightproof.store import Run, Store
from lightproof.suite import Suite
from lightproof.trial import Result, Status, Trial

STEPS = (64, 256, 1024, 4096)
REPLICATES = 16
SAMPLES_PER_SECOND = 1e6
NOISE = 0.1  # standard deviation of one sample, of the film's largest value
TRIANGLES = {"path": lambda size: np.linspace(0, 2e-4, size), "mc-cosine": lambda size: np.full(size, np.inf)}
HOSTILE = '<img src=x onerror="window.hacked=1">'
CRASH = "it wrote \x1b[31m<script>window.hacked=1</script>\u202e\udcff and died"
REFUSAL = "pyrender has no area lights"

LIGHT = {"id": "lamp", "kind": "area", "radiance": 2.04,
         "shape": {"type": "polygon", "vertices": [[-0.4, -0.7, 1.4], [-0.4, 0.3, 1.4], [0.6, 0.3, 1.4], [0.6, -0.7, 1.4]]}}
FILMS = {
    "floor": {"kind": "plane", "quantity": "irradiance", "origin": [-1, -1, 0], "u": [2, 0, 0], "v": [0, 1.5, 0],
              "resolution": [8, 6]},
    "view": {"kind": "camera", "quantity": "radiance", "projection": "perspective", "origin": [0, -2, 1], "target": [0, 0, 0],
             "up": [0, 0, 1], "fov": 40, "resolution": [8, 6]},
    "spots": {"kind": "points", "quantity": "irradiance", "positions": [[0, 0, 0], [0.3, 0, 0]],
              "normals": [[0, 0, 1], [0, 0, 1]]},
}
BIBLIOGRAPHY = """@article{ramp2026,
  author = {Ada {Ramp} and Bo Slope},
  title = {On <ramps>},
  year = 2026,
  doi = {10.1000/1},
}
"""


def scene(name: str) -> Scene:
    """One of the three scenes."""
    table = {"title": f"The {name} <em>& more</em>", "tests": "nothing real", "max_bounces": 0, "tolerance": 0.01,
             "light": [LIGHT], "film": FILMS[name]}
    return from_table(table, name)


def exact(scene: Scene) -> np.ndarray:
    """Light that rises from element to element, 0.5 to 1 W/m2."""
    return np.linspace(0.5, 1.0, scene.size)


def films(method: str, scene: Scene, samples: int) -> np.ndarray:
    """(replicates, n) films of a method at a step: exact, noisy, biased by a thousandth, or wrong by pi."""
    random = np.random.default_rng([samples, len(method), len(scene.id)])
    value = exact(scene)
    if method == "analytic":
        return value[None]
    noise = random.normal(0, NOISE / np.sqrt(samples), (REPLICATES, scene.size))
    return value * {"path": 1.004, "mc-cosine": np.pi}.get(method, 1.0) + noise


def results(method: str, scene: Scene) -> list[Result]:
    """Everything one method gave for a scene."""
    first = Trial(scene.id, scene.case, scene.digest, method, STEPS[0], 0)
    if method == "pyrender":
        return [Result(first, Status.UNSUPPORTED, message=REFUSAL)]
    if method == "cycles":
        return [Result(first, Status.ERROR, message=CRASH)]
    return [
        Result(replace(first, samples=samples, replicate=replicate), Status.OK, film=film, samples=samples, threads=2,
               version="1.2.3", seconds={"setup": 0.01, "compile": 0.2, "render": samples * scene.size / SAMPLES_PER_SECOND},
               settings={"sampler": "independent"}, precision="float32",
               deterministic=method == "analytic", tessellation=TRIANGLES.get(method, lambda size: None)(scene.size))
        for samples in STEPS for replicate, film in enumerate(films(method, scene, samples))
    ]


METHODS = ("analytic", "mc-area", "mc-cosine", "path", "cycles", "pyrender", HOSTILE)
SCENES = tuple(map(scene, FILMS))


def make(folder: Path) -> tuple[Store, Suite]:
    """The run recorded in a folder, and a suite with its references."""
    suite = Suite(folder)
    (folder / "references").mkdir()
    for scene in SCENES:
        _write_reference(folder / "references", scene)
    (folder / "references" / "references.bib").write_text(BIBLIOGRAPHY, encoding="utf-8")
    run = Run("run-1", "2026-01-02T03:04:05+00:00", "digest", "a <machine>", 2, 7, {"lightproof": "0.1.0"}, "abc123",
              {"budget": 200.0})
    record = store.create(folder / "runs", run, SCENES)
    for result in (result for scene in SCENES for method in METHODS for result in results(method, scene)):
        if result.film is not None:
            path = record.film_path(result.trial)
            path.parent.mkdir(parents=True, exist_ok=True)
            triangles = {} if result.tessellation is None else {"tessellation": result.tessellation}
            write_film(path, (1, len(result.film)), {"Y": result.film, **triangles}, {})
        record.append(result)
    return store.open(record.folder), suite


def _write_reference(folder: Path, scene: Scene) -> None:
    rows = [f"base,{element},{value:.17g},1e-15" for element, value in enumerate(exact(scene))]
    (folder / f"{scene.id}.csv").write_text("\n".join(["case,element,value,uncertainty", *rows]) + "\n")
    (folder / f"{scene.id}.toml").write_text(
        'formula = "E = ½ (1 + i/n)"\ncitations = ["ramp2026"]\nsource = "a ramp"\n[cases.base]\n'
        f'scene_digest = "{scene.digest}"\nengine = "ramp"\nsecond_engine = "ramp"\nagreement = 0.0\nkind = "enclosure"\n'
        "uncertainty = 1e-15\nelements_checked = 48\n", encoding="utf-8")
