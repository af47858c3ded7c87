"""Renders scenes in a process that holds one renderer and nothing else: `python one_process.py METHOD IN.json OUT.json`."""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lightproof import scene_file
from lightproof.method import Unavailable
from lightproof.renderers.registry import METHODS
from lightproof.scene import Scene

MISSING = 3


@dataclass(frozen=True)
class Shot:
    """What is asked for: a scene, samples per element, a seed."""

    scene: Scene
    samples: int
    seed: int = 1


def render(method: str, shots: list[Shot], folder: Path) -> list[dict[str, Any]]:
    """For each shot the film (n,), real samples, quantization and settings, or the reason why it is unsupported. Skips, with
    the command that installs it, where the renderer is not there."""
    asked, answered = folder / "in.json", folder / "out.json"
    asked.write_text(json.dumps([{"table": shot.scene.to_table(), "id": shot.scene.id, "samples": shot.samples, "seed": shot.seed}
                                 for shot in shots]))
    command = [sys.executable, __file__, method, str(asked), str(answered)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    if done.returncode == MISSING:
        pytest.skip(answered.read_text())
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads(answered.read_text())


def main(name: str, asked: Path, answered: Path) -> None:
    """Render every shot in `asked` and leave the films in `answered`."""
    module, _, cls = METHODS[name].target.partition(":")
    method = getattr(importlib.import_module(module), cls)(name, 2)
    try:
        method.open()
    except Unavailable as error:
        answered.write_text(str(error))
        os._exit(MISSING)
    answered.write_text(json.dumps([_shot(method, shot) for shot in json.loads(asked.read_text())]))
    os._exit(0)


def _shot(method: Any, shot: dict[str, Any]) -> dict[str, Any]:
    scene = scene_file.from_table(shot["table"], shot["id"])
    reason = method.unsupported(scene)
    if reason:
        return {"unsupported": reason}
    method.prepare(scene)
    rendering = method.render(shot["samples"], shot["seed"])
    steps = np.broadcast_to(rendering.quantization, rendering.film.shape)
    return {"film": rendering.film.tolist(), "samples": rendering.samples, "quantization": steps.tolist(),
            "settings": dict(method.settings()), "seconds": dict(rendering.seconds)}


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]))
