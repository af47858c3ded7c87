"""Films as OpenEXR: 32-bit float channels that tev and Blender open, with what the film is in the header.

Channel Y is the film. A method that computes in float64 keeps its digits: `residual` is what rounding Y to float32 left
out, and `residual2` what rounding that did. `variance`, `quantization`, `tessellation`, `peak` and `bound` are there where
the method knows them.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import metadata
from pathlib import Path

import numpy as np

from lightproof import exr
from lightproof.exr import FilmError

RESIDUALS = ("residual", "residual2")
EXTRAS = ("variance", "quantization", "tessellation", "peak", "bound")
PARTIAL = ".partial"  # what a film is called until it is whole


def write(path: Path, grid: tuple[int, int], channels: Mapping[str, np.ndarray], header: Mapping[str, str]) -> None:
    """Write (n,) arrays as channels of a rows x columns image, whole or not at all: first beside `path`, then renamed."""
    import OpenEXR

    with np.errstate(over="ignore"):
        planes = {name: np.asarray(values, float).astype(np.float32) for name, values in channels.items()}
    if np.isfinite(planes["Y"]).all():
        left = np.asarray(channels["Y"], float) - planes["Y"]
        for name in RESIDUALS:
            planes[name] = np.asarray(left, np.float32)
            left = left - planes[name]
    images = {name: np.ascontiguousarray(plane.reshape(grid)) for name, plane in planes.items()}
    about = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, "lightproof": _version(), **header}
    partial = path.with_suffix(PARTIAL)
    OpenEXR.File(about, images).write(str(partial))
    partial.rename(path)


@np.errstate(invalid="ignore")
def read(path: Path, channel: str = "") -> tuple[tuple[int, int], dict[str, np.ndarray], dict[str, str]]:
    """Grid (rows, columns), channels as (n,) float64 and the header's strings, of a film or of anybody's picture.

    Y is the light: the channel Y with its residual added back, or the mean of R, G and B, or what `channel` names (see
    `exr.Image.light`); `spread` is what R, G and B lie apart, where they do. Half floats are good to half a step, which
    `quantization` says. Raises FilmError where the file is missing, truncated or no flat OpenEXR image, or where its light is
    not to be found.
    """
    image = exr.read(path)
    names = image.light(channel)
    chosen = [_numbers(image, name) for name in names]
    found = {"Y": np.mean(chosen, axis=0)}
    if (spread := np.ptp(chosen, axis=0)).any():
        found["spread"] = spread
    if names == ("Y",):
        found["Y"] = sum((image.channels[name] for name in RESIDUALS if name in image.channels), found["Y"])
        found |= {name: _numbers(image, name) for name in EXTRAS if name in image.channels}
    steps = np.mean([np.broadcast_to(exr.half_step(image.channels[name]), found["Y"].shape) for name in names], axis=0)
    if steps.any():
        found["quantization"] = steps + found.get("quantization", 0.0)
    return found["Y"].shape, {name: values.ravel() for name, values in found.items()}, dict(image.header)


def _numbers(image: exr.Image, name: str) -> np.ndarray:
    if image.channels[name].dtype.kind != "f":
        raise FilmError(f"{image.path}: channel {name} holds whole numbers; light is half or float")
    with np.errstate(invalid="ignore"):  # a signalling NaN is as good as any
        return image.channels[name].astype(float)


@cache
def _version() -> str:
    """Of the package; unknown to an interpreter in which it is not installed, such as one that holds another renderer."""
    try:
        return metadata.version("lightproof")
    except metadata.PackageNotFoundError:
        return "unknown"
