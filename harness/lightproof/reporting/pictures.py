"""A rendered picture of a scene's set-up, made by Mitsuba in a process of its own and kept by the scene's digest.

`python -m lightproof.reporting.pictures OUT.png` reads a scene (JSON: id, case, table) from standard input.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from lightproof import scene_file
from lightproof.method import Unavailable
from lightproof.renderers import importing, mitsuba
from lightproof.reporting import framing, stage
from lightproof.scene import Scene

WIDTH, HEIGHT = 800, 500
SAMPLES = 25
BACKGROUND = np.array([0.80, 0.83, 0.87])
FILL = 0.56  # weight of the white surrounding
GLOW = 0.66  # weight of the scene's own light
SECONDS = 600
MISSING = 3  # exit status: the renderer is not there


def picture(scene: Scene, cache_folder: Path) -> bytes:
    """PNG of the set-up, from the cache or rendered anew. Raises Unavailable where Mitsuba is not installed, and
    RuntimeError with its last line where it fails."""
    path = cache_folder / f"{scene.digest[:24]}-{_recipe()}.png"
    if not path.is_file():
        cache_folder.mkdir(parents=True, exist_ok=True)
        partial = path.with_suffix(f".{os.getpid()}.partial")
        _render_apart(scene, partial)
        partial.rename(path)
    return path.read_bytes()


def _recipe() -> str:
    """Changes when the way in which pictures are made does."""
    sources = b"".join(Path(module.__file__).read_bytes() for module in (sys.modules[__name__], stage, framing))
    return hashlib.sha256(sources).hexdigest()[:8]


def _render_apart(scene: Scene, path: Path) -> None:
    about = json.dumps({"id": scene.id, "case": scene.case, "table": scene.to_table()})
    command = [sys.executable, "-m", "lightproof.reporting.pictures", str(path)]
    done = subprocess.run(command, input=about, capture_output=True, text=True, timeout=SECONDS, check=False)
    last = (done.stderr.strip().splitlines() or ["no message"])[-1]
    if done.returncode == MISSING:
        raise Unavailable(last)
    if done.returncode:
        raise RuntimeError(f"the picture of {scene.name} could not be rendered: {last}")


def main() -> None:
    """Render the scene on standard input into the file that the command line names."""
    about = json.load(sys.stdin)
    scene = scene_file.from_table(about["table"], about["id"], about["case"]).tangible
    try:
        mi = _mitsuba()
    except Unavailable as error:
        sys.exit(print(error, file=sys.stderr) or MISSING)
    Path(sys.argv[1]).write_bytes(_png(_compose(mi, scene)))


def _mitsuba() -> ModuleType:
    os.environ.setdefault("DRJIT_LIBLLVM_PATH", mitsuba.llvm_library())
    mi = importing.renderer("mitsuba", "mitsuba")
    mi.set_variant("llvm_ad_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    return mi


def _compose(mi: ModuleType, scene: Scene) -> np.ndarray:
    """Linear image (rows, columns, 3): background, the set-up in white surroundings, and its own light on top."""
    fill = _shoot(mi, stage.Stage(mi, scene, lit=False), {"surrounding": {"type": "constant", "radiance": 1.0}})
    own = _shoot(mi, stage.Stage(mi, scene, lit=True), {})[:, :, :3]
    alpha = fill[:, :, 3:].clip(0, 1)
    return BACKGROUND * (1 - alpha) + FILL * fill[:, :, :3] + GLOW * _developed(own)


def _developed(light: np.ndarray) -> np.ndarray:
    """The scene's own light, exposed so that what it shines on is bright and lamps just saturate."""
    grey = light.mean(axis=2)
    shone_on = grey[(grey > 0) & (grey < grey.max() / 2)]
    if not shone_on.size:
        shone_on = grey[grey > 0]
    return 1 - np.exp(-light / np.percentile(shone_on, 90)) if shone_on.size else light


def _shoot(mi: ModuleType, setup: stage.Stage, around: dict[str, Any]) -> np.ndarray:
    """Linear image (rows, columns, 4) of a stage; alpha is 0 where nothing stands."""
    camera = framing.camera(setup.points, WIDTH / HEIGHT)
    place = mi.ScalarTransform4f().look_at(origin=camera.origin, target=camera.target, up=[0, 0, 1])
    film = {"type": "hdrfilm", "width": WIDTH, "height": HEIGHT, "pixel_format": "rgba", "rfilter": {"type": "gaussian"}}
    sensor = {"type": "perspective", "fov": camera.fov, "fov_axis": "x", "to_world": place, "film": film,
              "near_clip": 1e-3 * setup.box.size, "far_clip": 1e3 * setup.box.size, "sampler": {"type": "multijitter"}}
    integrator = {"type": "path", "max_depth": 3, "hide_emitters": bool(around)}
    built = mi.load_dict({"type": "scene", "integrator": integrator, "sensor": sensor, **around, **setup.parts})
    return np.nan_to_num(np.array(mi.render(built, spp=SAMPLES, seed=1), float))


def _png(linear: np.ndarray) -> bytes:
    from PIL import Image

    linear = linear.clip(0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    out = io.BytesIO()
    Image.fromarray((255 * encoded + 0.5).astype(np.uint8)).save(out, "PNG", optimize=True)
    return out.getvalue()


if __name__ == "__main__":
    main()
