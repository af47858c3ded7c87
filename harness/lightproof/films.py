"""Films as OpenEXR: 32-bit float channels that tev and Blender open, with what the film is in the header.

Channel Y is the film. A method that computes in float64 keeps its digits: `residual` is what rounding Y to float32 left
out. `variance` and `quantization` are there where the method knows them.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np


class FilmError(ValueError):
    """A film that cannot be read or does not fit: says what, where and what would be right."""


def write(path: Path, grid: tuple[int, int], channels: Mapping[str, np.ndarray], header: Mapping[str, str]) -> None:
    """Write (n,) arrays as channels of a rows x columns image, whole or not at all: first beside `path`, then renamed."""
    import OpenEXR

    planes = {}
    for name, values in channels.items():
        values = np.asarray(values, float)
        planes[name] = values.astype(np.float32)
        if name == "Y" and np.isfinite(planes[name]).all():
            planes["residual"] = (values - planes[name]).astype(np.float32)
    images = {name: np.ascontiguousarray(plane.reshape(grid)) for name, plane in planes.items()}
    about = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **header}
    partial = path.with_suffix(".partial")
    OpenEXR.File(about, images).write(str(partial))
    partial.rename(path)


def read(path: Path) -> tuple[tuple[int, int], dict[str, np.ndarray], dict[str, str]]:
    """Grid (rows, columns), channels as (n,) float64 with the residual added back to Y, and the header's strings.

    Raises FilmError on a file that is missing, truncated or no OpenEXR.
    """
    import OpenEXR

    if not path.is_file():
        raise FilmError(f"{path}: there is no such file; give the path of an OpenEXR image")
    try:
        with OpenEXR.File(str(path), separate_channels=True) as file:
            header = {key: value for key, value in file.header().items() if isinstance(value, str)}
            planes = {name: np.array(channel.pixels) for name, channel in file.channels().items()}
    except Exception as error:  # the binding raises bare RuntimeError, or a TypeError of its own, on foreign bytes
        raise FilmError(f"{path}: is no complete OpenEXR image ({error}); it may be truncated, write it again") from None
    if "Y" not in planes:
        raise FilmError(f"{path}: has no channel Y; its channels are {', '.join(sorted(planes)) or 'none'}")
    grid = planes["Y"].shape
    channels = {name: plane.astype(np.float64).ravel() for name, plane in planes.items()}
    channels["Y"] = channels["Y"] + channels.pop("residual", 0.0)
    return grid, channels, header
