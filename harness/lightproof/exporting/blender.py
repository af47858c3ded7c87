"""Blender: a .blend file with a scene as the Cycles adapter builds it, written by Blender's own module in a child process."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from lightproof import exporting, scene_file
from lightproof.exporting import CannotExport
from lightproof.method import Unavailable
from lightproof.renderers.cycles import Cycles
from lightproof.scene import Scene

SAMPLES = 1024
SECONDS = 120
UNAVAILABLE, UNSUPPORTED = 3, 4  # exit statuses of the child; its last line says why


def write(scene: Scene, path: Path) -> None:
    """See `exporting.Tool`. Raises Unavailable without bpy."""
    picture = f"{path.stem}-0001.exr"
    render = f"Render: blender -b {path.name} -o //{path.stem}- -f 1, which writes {picture}."
    head = [*exporting.remarks(scene, path, picture), render]
    job = {"id": scene.id, "case": scene.case, "table": scene.to_table(), "head": head, "path": str(path.resolve())}
    command = [sys.executable, "-m", "lightproof.exporting.blender"]
    try:
        done = subprocess.run(command, input=json.dumps(job), capture_output=True, text=True, timeout=SECONDS, check=False)
    except subprocess.TimeoutExpired:
        raise CannotExport(f"Blender did not finish within {SECONDS} s") from None
    said = (done.stderr.strip().splitlines() or [f"it ended with status {done.returncode}"])[-1]
    if done.returncode == UNAVAILABLE:
        raise Unavailable(said)
    if done.returncode or not path.is_file():
        raise CannotExport(f"Blender did not write {path}: {said}")


def main() -> int:
    """In the child: build the scene of the job on standard input, save it, and say on standard error what is wrong."""
    job = json.load(sys.stdin)
    scene, blender = scene_file.from_table(job["table"], job["id"], job["case"]), Cycles("cycles", os.cpu_count() or 1)
    try:
        blender.open()
    except Unavailable as missing:
        print(missing, file=sys.stderr)
        return UNAVAILABLE
    reason = blender.unsupported(scene)
    if reason:
        print(reason, file=sys.stderr)
        return UNSUPPORTED
    blender.prepare(scene)
    _save(blender, job["head"], Path(job["path"]))
    return 0


def _save(blender: Cycles, head: list[str], path: Path) -> None:
    """The one view's scene alone, ready to render, with the remarks as a text of the file."""
    bpy, (kept, *_) = blender.bpy, blender.sets
    bpy.context.window.scene = kept
    for other in [each for each in bpy.data.scenes if each != kept]:
        bpy.data.scenes.remove(other)
    kept.cycles.samples, kept.cycles.seed, kept.render.filepath = SAMPLES, 0, f"//{path.stem}.exr"
    kept.render.threads_mode = "AUTO"
    block = kept.render.resolution_x // blender.views[0].resolution[0]
    if block > 1:
        head = [*head, f"Blender's pictures are at least 4 pixels high and wide: an element is {block} x {block} pixels here."]
    bpy.data.texts.new("lightproof").from_string("\n".join(head))
    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False)


if __name__ == "__main__":
    status = main()
    sys.stderr.flush()
    os._exit(status)  # Blender may crash while it is torn down
