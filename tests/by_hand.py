"""Renders exported files as their user would, in the tool itself: `python by_hand.py TOOL FOLDER SAMPLES REPLICATES` leaves
NAME-0.exr, NAME-1.exr and so on, of different seeds, beside every file of the folder."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def mitsuba(path: Path, samples: int, replicates: int) -> None:
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    scene = mi.load_file(str(path), spp=str(samples))
    for seed in range(replicates):
        mi.render(scene, seed=100 + seed)
        scene.sensors()[0].film().write(str(path.with_name(f"{path.stem}-{seed}.exr")))


def blender(path: Path, samples: int, replicates: int) -> None:
    import bpy

    bpy.ops.wm.open_mainfile(filepath=str(path))
    scene = bpy.context.scene
    scene.cycles.samples = samples
    for seed in range(replicates):
        scene.cycles.seed, scene.render.filepath = 100 + seed, f"//{path.stem}-{seed}.exr"
        bpy.ops.render.render(write_still=True)


TOOLS = {"mitsuba": (mitsuba, ".xml"), "blender": (blender, ".blend")}

if __name__ == "__main__":
    render, suffix = TOOLS[sys.argv[1]]
    for each in sorted(Path(sys.argv[2]).glob(f"*{suffix}")):
        render(each, int(sys.argv[3]), int(sys.argv[4]))
    os._exit(0)
