"""Any OpenEXR image, whichever program wrote it: layers and parts, tiles and scan lines, half and float.

A picture is what the display window shows. As the standard has it, it is black where the data window does not reach, and
what the data window holds beyond it is not part of the picture.
"""

from __future__ import annotations

import contextlib
import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lightproof.quiet import quiet

PIXELS, VALUES = 1 << 25, 1 << 28  # in one file, twice the largest film's; a header that claims more is not followed
LUMINANCE, COLOUR = ("Y",), ("R", "G", "B")  # Y beside X is no luminance, but a part of a vector
WRITE_AGAIN = "it may be truncated; write it again"

Window = tuple[int, int, int, int]


class FilmError(ValueError):
    """A film that cannot be read or does not fit: says what, where and what would be right."""


@dataclass(frozen=True)
class Image:
    """`channels` (rows, columns) by full name, in the number format of the file; in a file of several parts a name begins with
    its part's. `header`: the strings of the first part."""

    path: Path
    channels: Mapping[str, np.ndarray]
    header: Mapping[str, str]

    def light(self, channel: str = "") -> tuple[str, ...]:
        """The channels that hold the light: Y, or R, G and B, of the file's own layer or else of the only one that has them.
        `channel` names one, or the layer. Raises FilmError, which says what there is."""
        if channel in self.channels:
            return (channel,)
        lit = self._lit_layers()
        layer = channel if channel or "" in lit or len(lit) != 1 else next(iter(lit))
        if layer in lit:
            return lit[layer]
        wanted = f"channel or lit layer {channel!a}" if channel else "one layer with a channel Y, or channels R, G and B"
        there = ", ".join(sorted(self.channels)) or "none"
        raise FilmError(f"{self.path}: has no {wanted}; choose among its channels: {there}")

    def _lit_layers(self) -> dict[str, tuple[str, ...]]:
        found: dict[str, tuple[str, ...]] = {}
        for layer in dict.fromkeys(name.rpartition(".")[0] for name in self.channels):
            prefix = f"{layer}." if layer else ""
            for names in (LUMINANCE, COLOUR):
                full = tuple(prefix + name for name in names)
                if self.channels.keys() >= set(full) and (names != LUMINANCE or f"{prefix}X" not in self.channels):
                    found.setdefault(layer, full)
        return found


def read(path: Path) -> Image:
    """The picture in a file. Raises FilmError where there is none, or none that is flat, whole and of bearable size."""
    if not path.is_file():
        raise FilmError(f"{path}: there is no such file; give the path of an OpenEXR image")
    try:
        with quiet(2), contextlib.redirect_stdout(io.StringIO()):  # where the library reports what it then raises, or leaves out
            return _read(path)
    except FilmError:
        raise
    except Exception as error:  # the binding raises bare RuntimeError, or a TypeError of its own, on foreign bytes
        raise FilmError(f"{path}: is no OpenEXR image that can be read ({error}); {WRITE_AGAIN}") from None


def _read(path: Path) -> Image:
    import OpenEXR

    with OpenEXR.File(str(path), header_only=True) as file:
        headers = [dict(part.header) for part in file.parts]
    display = _display(path, headers)
    with OpenEXR.File(str(path), separate_channels=True) as file:
        parts = [(part.name(), part.header, dict(part.channels)) for part in file.parts]
        channels = _channels(path, parts, display)
    if len(parts) != len(headers):  # what cannot be decoded is left out
        raise FilmError(f"{path}: pixels of {len(headers) - len(parts)} of {len(headers)} parts are missing; {WRITE_AGAIN}")
    return Image(path, channels, {key: value for key, value in headers[0].items() if isinstance(value, str)})


def half_step(values: np.ndarray) -> np.ndarray | float:
    """Half a step of the number format at every value, where that is half float; 0 for float, whose steps are small enough."""
    with np.errstate(invalid="ignore"):
        return np.spacing(np.abs(values)).astype(float) / 2 if values.dtype == np.float16 else 0.0


def _display(path: Path, headers: list[dict[str, Any]]) -> Window:
    """The display window, once every header is known to be of a flat image of bearable size."""
    for header in headers:
        if "deep" in str(header.get("type")):
            raise FilmError(f"{path}: is a deep image; flatten it")
        channels = len(header["channels"])
        for name, (columns, rows) in _sizes(header).items():
            if columns * rows > PIXELS or columns * rows * channels > VALUES:
                raise FilmError(f"{path}: claims {columns} x {rows} pixels ({name}) in {channels} channels; at most {PIXELS}"
                                f" pixels and {VALUES} values are read")
    return _window(headers[0]["displayWindow"])


def _sizes(header: dict[str, Any]) -> dict[str, tuple[int, int]]:
    """Columns and rows of what the header makes the library and us set aside memory for."""
    windows = {name: _window(header[name]) for name in ("dataWindow", "displayWindow")}
    sizes = {name: (right - left + 1, bottom - top + 1) for name, (left, top, right, bottom) in windows.items()}
    return sizes | ({"tiles": (header["tiles"].xSize, header["tiles"].ySize)} if "tiles" in header else {})


def _window(corners: Any) -> Window:
    (left, top), (right, bottom) = corners
    return int(left), int(top), int(right), int(bottom)


def _channels(path: Path, parts: list[tuple[str, dict[str, Any], dict[str, Any]]], display: Window) -> dict[str, np.ndarray]:
    """Every channel that has a value in each pixel, by its full name."""
    found = {}
    for name, header, channels in parts:
        prefix = f"{name}." if name and len(parts) > 1 else ""
        for channel, content in channels.items():
            if (content.xSampling, content.ySampling) == (1, 1):
                full = channel if channel.startswith(prefix) else prefix + channel
                found[full] = _shown(path, content.pixels, _window(header["dataWindow"]), display)
    return found


def _shown(path: Path, pixels: np.ndarray, data: Window, display: Window) -> np.ndarray:
    """What the display window shows of the data window's `pixels`."""
    if data == display:
        return np.array(pixels)
    left, top, right, bottom = display
    shown = np.zeros((bottom - top + 1, right - left + 1), pixels.dtype)
    x, y = slice(max(left, data[0]), min(right, data[2]) + 1), slice(max(top, data[1]), min(bottom, data[3]) + 1)
    if x.start >= x.stop or y.start >= y.stop:
        raise FilmError(f"{path}: its data window {data} lies outside its display window {display}, which shows nothing")
    shown[y.start - top:y.stop - top, x.start - left:x.stop - left] = \
        pixels[y.start - data[1]:y.stop - data[1], x.start - data[0]:x.stop - data[0]]
    return shown
