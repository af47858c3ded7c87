"""Films in OpenEXR keep every digit, and a file that is none says so."""

from __future__ import annotations

import numpy as np
import pytest

from lightproof import films


def test_float64_round_trip(tmp_path):
    """A film of 12 elements comes back to 1e-14, its header word for word."""
    values = np.geomspace(1e-9, 1e9, 12)
    films.write(tmp_path / "a.exr", (3, 4), {"Y": values, "variance": values / 7}, {"seed": "4294967297", "method": "mc-area"})
    grid, channels, header = films.read(tmp_path / "a.exr")
    assert grid == (3, 4)
    np.testing.assert_allclose(channels["Y"], values, rtol=1e-14)
    np.testing.assert_allclose(channels["variance"], values / 7, rtol=1e-7)
    assert header["seed"] == "4294967297" and header["method"] == "mc-area"
    assert not list(tmp_path.glob("*.partial"))


def test_values_that_no_float32_holds_survive_as_what_they_are(tmp_path):
    """NaN and infinity are the judge's business: the file keeps them."""
    films.write(tmp_path / "a.exr", (1, 3), {"Y": np.array([np.nan, np.inf, 0.1])}, {})
    _, channels, _ = films.read(tmp_path / "a.exr")
    assert np.isnan(channels["Y"][0]) and np.isinf(channels["Y"][1])


def test_truncated_foreign_and_missing_files(tmp_path, capfd):
    films.write(tmp_path / "whole.exr", (64, 64), {"Y": np.random.default_rng(1).random(4096)}, {})
    data = (tmp_path / "whole.exr").read_bytes()
    (tmp_path / "half.exr").write_bytes(data[: len(data) // 2])
    (tmp_path / "text.exr").write_text("not an image")
    for name in ("half.exr", "text.exr"):
        with pytest.raises(films.FilmError, match=name):
            films.read(tmp_path / name)
    with pytest.raises(films.FilmError, match="no such file"):
        films.read(tmp_path / "none.exr")
    films.write(tmp_path / "z.exr", (1, 2), {"Z": np.ones(2)}, {})
    with pytest.raises(films.FilmError, match="no channel Y"):
        films.read(tmp_path / "z.exr")
