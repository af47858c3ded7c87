"""Half a sky as a picture, for renderers whose skies are whole or a picture."""

from __future__ import annotations

import numpy as np

ROWS = 2**11  # the horizon is blurred over one of them


def picture(radiance: float) -> np.ndarray:
    """Latitudes by longitudes (ROWS, 4) in float32, the zenith in row 0: `radiance` above the horizon, black below."""
    rows = np.zeros((ROWS, 4), np.float32)
    rows[: ROWS // 2] = radiance
    return rows
