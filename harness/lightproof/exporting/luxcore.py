"""LuxCore: a .cfg that says how to render and a .scn that says what, meshes as .ply and half a sky as .exr beside them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lightproof import exporting
from lightproof.exporting.mitsuba import write_grey, write_ply
from lightproof.renderers import luxcore, luxcore_scene
from lightproof.renderers.luxcore_scene import Stage
from lightproof.scene import AreaLight, DirectionalLight, Environment, PointLight, Scene

SAMPLES = 1024  # or more: LuxCore looks only now and then whether it has enough
PYTHON = """\
    import pyluxcore, time
    pyluxcore.Init()
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(pyluxcore.Properties({config!r})))
    session.Start()
    while not session.HasDone():
        time.sleep(0.01)
        session.UpdateStats()
    session.Stop()
    session.GetFilm().Save()
"""


def write(scene: Scene, path: Path) -> None:
    """See `exporting.Tool`; the main file is the .cfg."""
    exporting.refuse(scene, AreaLight | PointLight | DirectionalLight | Environment, "LuxCore")
    view = exporting.view(scene)
    columns, rows = view.resolution
    described = path.with_suffix(".scn")
    how = {**luxcore_scene.configuration(scene), **luxcore.ENGINES[""], "scene.file": described.name,
           "film.width": columns, "film.height": rows, "batch.haltspp": SAMPLES, "film.outputs.0.filename": f"{path.stem}.exr"}
    what: dict[str, Any] = {}
    for stage in (luxcore_scene.contents(scene), luxcore_scene.seen(view)):
        what |= stage.properties | _companions(stage, path)
    described.write_text(_text(what), encoding="utf-8")
    path.write_text("".join(f"# {line}\n" for line in _remarks(scene, path)) + _text(how), encoding="utf-8")


def _remarks(scene: Scene, path: Path) -> list[str]:
    return [*exporting.remarks(scene, path),
            "LuxCore's pictures are one pixel too high, so the camera's screen window is one pixel too low.",
            f"Render: luxcoreconsole {path.name}, or in Python:", *PYTHON.format(config=path.name).splitlines()]


def _companions(stage: Stage, path: Path) -> dict[str, Any]:
    """Write a stage's meshes and images; what the scene has to say of them."""
    said: dict[str, Any] = {}
    for name, shape in stage.meshes.items():
        companion = exporting.companion(path, f"{name}.ply")
        write_ply(shape, companion)
        said |= {f"scene.shapes.{name}.type": "mesh", f"scene.shapes.{name}.ply": companion.name}
    for name, image in stage.images.items():
        companion = exporting.companion(path, f"{name}.exr")
        write_grey(image, companion)
        said |= {f"scene.lights.{name}.file": companion.name, f"scene.lights.{name}.gamma": 1.0}
    return said


def _text(properties: Mapping[str, Any]) -> str:
    return "".join(f"{name} = {_value(value)}\n" for name, value in properties.items())


def _value(value: Any) -> str:
    match value:
        case str():
            return f'"{value}"'
        case list():
            return " ".join(map(repr, value))
        case _:
            return str(int(value) if isinstance(value, bool) else value)
