"""Two colour maps, and films drawn with them; neither map relies on telling red from green."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass

import numpy as np
from PIL import Image

from lightproof.scene import Film, PlaneFilm

LEVELS = 255  # odd, so that the middle of a signed scale has a colour of its own


@dataclass(frozen=True)
class ColourMap:
    """Colours at equal distances, linearly interpolated in sRGB between them, as CSS does with a gradient."""

    anchors: tuple[str, ...]

    @property
    def css(self) -> str:
        """The map as a CSS gradient from left to right."""
        return f"linear-gradient(to right, {', '.join('#' + anchor for anchor in self.anchors)})"

    @property
    def palette(self) -> np.ndarray:
        """The map as (LEVELS, 3) bytes."""
        colours = np.array([list(bytes.fromhex(anchor)) for anchor in self.anchors])
        at = np.linspace(0, len(colours) - 1, LEVELS)
        channels = [np.interp(at, np.arange(len(colours)), channel) for channel in colours.T]
        return np.stack(channels, axis=1).round().astype(np.uint8)


# Inferno, N. Smith and S. van der Walt for matplotlib (CC0): every third of the 31 anchors that Vega carries.
LIGHT = ColourMap(("000004", "170c3b", "420a68", "6b176e", "932667", "bb3755", "dd513a", "f3771a", "fca50a", "f6d645", "fcffa4"))

# RdBu turned round: blue is too dark, red too bright (C. Brewer, colorbrewer2.org).
SIGNED = ColourMap(("053061", "2166ac", "4393c3", "92c5de", "d1e5f0", "f7f7f7", "fddbc7", "f4a582", "d6604d", "b2182b", "67001f"))


def film_image(values: np.ndarray, film: Film, colours: ColourMap, low: float, high: float) -> str:
    """A film (n,) as a PNG data URI, an element a pixel; what lies outside [low, high] takes the map's end.

    A plane film is drawn as seen against its normal with row 0 at the bottom, a camera's with row 0 on top.
    """
    levels = (np.clip((values - low) / (high - low), 0, 1) * (LEVELS - 1)).round().astype(np.uint8).reshape(film.grid)
    image = Image.fromarray(levels[::-1] if isinstance(film, PlaneFilm) else levels)
    image.putpalette(colours.palette.tobytes())
    return data_uri(image, "PNG", optimize=True)


def shrunk(png: bytes) -> str:
    """A rendered picture as a WebP data URI, small enough for a page that holds many."""
    return data_uri(Image.open(io.BytesIO(png)).convert("RGB"), "WEBP", quality=85, method=6)


def data_uri(image: Image.Image, kind: str, **options: object) -> str:
    """An image as a data URI of `kind` (PNG or WEBP)."""
    buffer = io.BytesIO()
    image.save(buffer, kind, **options)
    return f"data:image/{kind.lower()};base64,{base64.b64encode(buffer.getvalue()).decode()}"
