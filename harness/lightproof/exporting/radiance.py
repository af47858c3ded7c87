"""Radiance: a .rad with lights, surfaces and materials, beside it a view (.vf) and the functions of its patterns (.cal).

The picture is rpict's, with the settings of the adapter, many small pixels for each of the film's, which pfilt averages.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lightproof import exporting
from lightproof.exporting import CannotExport, numbers
from lightproof.renderers import radiance, radiance_scene, radiance_transport
from lightproof.renderers.views import Receiver, View
from lightproof.scene import Scene

FINE = 8  # of rpict's pixels along each side of a film element
PIXELS = "-ps 1 -pt 0 -pj 1 -pa 0"  # every pixel is traced, somewhere in its square
HDR = ("A Radiance picture keeps 8 bits of a number, about 0.2 per cent. Turn it into OpenEXR with a tool that leaves numbers"
       " alone, such as oiiotool {0}.hdr -o {0}.exr.")


def write(scene: Scene, path: Path) -> None:
    """See `exporting.Tool`."""
    if any(letter.isspace() for letter in path.name):
        raise CannotExport(f"{path.name!r}: Radiance takes no blanks in the names of files; choose another name")
    view, planned = exporting.view(scene), radiance_transport.transport_of(scene)
    reason = radiance_transport.unsupported(scene, planned)
    if reason:
        raise CannotExport(reason)
    shapes = path.with_suffix(".cal")
    about = [*exporting.remarks(scene, path), *commands(scene, view, path), HDR.format(path.stem)]
    things = [*map("# {}".format, about), "", radiance_scene.describe(scene, planned, shapes.name)]
    path.write_text("\n".join([*things, *([_receiver(view.receiver)] if view.receiver else [])]), encoding="utf-8")
    shapes.write_text(radiance_scene.SHAPES, encoding="utf-8")
    path.with_suffix(".vf").write_text(_view(view), encoding="utf-8")


def commands(scene: Scene, view: View, path: Path) -> list[str]:
    """What to type in the folder of the files."""
    planned, (columns, rows) = radiance_transport.transport_of(scene), view.resolution
    options = radiance.options(scene, planned, radiance.strata(scene, planned), cache=False)
    size = f"-x {FINE * columns} -y {FINE * rows}"
    picture = " ".join([PIXELS, radiance.RANDOM, *(option for option in options if option != "-I+"), size])
    return [f"Render: oconv {path.name} > {path.stem}.oct",
            f"Render: rpict -vf {path.stem}.vf {picture} {path.stem}.oct | pfilt -1 -x /{FINE} -y /{FINE} > {path.stem}.hdr"]


def _receiver(receiver: Receiver) -> str:
    paint, corners = numbers([receiver.reflectance] * 3), numbers(receiver.corners)
    return f"void plastic film-paint\n0\n0\n5 {paint} 0 0\nfilm-paint polygon film-receiver\n0\n0\n12 {corners}\n"


def _view(view: View) -> str:
    perspective = view.projection == "perspective"
    width, height = (float(np.degrees(2 * np.arctan(half))) if perspective else 2 * half for half in view.half)
    return (f"rvu -vt{'v' if perspective else 'l'} -vp {numbers(view.origin)} -vd {numbers(view.target - view.origin)}"
            f" -vu {numbers(view.up)} -vh {width!r} -vv {height!r}\n")
