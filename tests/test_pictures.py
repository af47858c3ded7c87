"""Pictures of a scene's set-up: framed so that all is in them, rendered once, and absent with a reason without Mitsuba."""

from __future__ import annotations

import io
import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from lightproof import geometry, suite
from lightproof.geometry import Polygon
from lightproof.method import Unavailable
from lightproof.reporting import framing, pictures

SUITE = suite.default()


def test_a_picture_shows_something_and_is_made_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """occluded-square: 800 x 500 pixels, background in the corners, lamp, blocker and film inside; the second time it comes
    from the cache, which needs no renderer."""
    scene = SUITE.scene("occluded-square")
    try:
        picture = pictures.picture(scene, tmp_path)
    except Unavailable as error:
        pytest.skip(str(error))
    image = np.asarray(Image.open(io.BytesIO(picture)), float)
    assert image.shape == (500, 800, 3)
    background = image[0, 0]
    assert all((abs(image[row, column] - background) < 2).all() for row in (0, -1) for column in (0, -1))
    shown = (abs(image - background) > 8).any(axis=2)
    assert 0.2 < shown.mean() < 0.9
    assert np.ptp(np.nonzero(shown)[1]) > 640 or np.ptp(np.nonzero(shown)[0]) > 400
    monkeypatch.setattr(subprocess, "run", None)
    assert pictures.picture(scene, tmp_path) == picture


def test_without_mitsuba_there_is_a_reason(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """The process that renders says that Mitsuba is missing, or breaks: the message comes through, and nothing is cached."""
    scene = SUITE.scene("square-light")
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: _ended(pictures.MISSING, "mitsuba is not installed: pip install it"))
    with pytest.raises(Unavailable, match="mitsuba is not installed"):
        pictures.picture(scene, tmp_path)
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: _ended(1, "out of memory"))
    with pytest.raises(RuntimeError, match="square-light could not be rendered: out of memory"):
        pictures.picture(scene, tmp_path)
    assert not list(tmp_path.iterdir())


def _ended(status: int, message: str) -> subprocess.CompletedProcess[str]:
    return subprocess.CompletedProcess([], status, "", message)


def test_the_camera_sees_every_point_and_no_more():
    """1,000 random points: all project inside the frame, and the extreme ones reach the border that is left free."""
    points = np.random.default_rng(7).normal(size=(1000, 3)) * (3.1, 0.7, 1.9) + (5, -2, 11)
    camera = framing.camera(points, 1.6)
    right, up, forward = geometry.camera_frame(tuple(camera.origin), tuple(camera.target), (0, 0, 1))
    way = points - camera.origin
    across = way @ right / (way @ forward) / np.tan(np.radians(camera.fov) / 2)
    along = way @ up / (way @ forward) / np.tan(np.radians(camera.fov) / 2) * 1.6
    assert max(abs(across).max(), abs(along).max()) == pytest.approx(1 / framing.BORDER, rel=1e-9)


def test_what_is_large_is_cut_where_the_picture_ends():
    """A blade of 80 m x 40 m cut by a box of 2 m: the part of the box's cross-section beyond its edge, 1 m x 2 m; and nothing
    of a sheet that lies outside."""
    box = framing.Box(np.array([-1.0, -1, -1]), np.array([1.0, 1, 1]))
    blade = Polygon(((0, -40, 0.5), (40, -40, 0.5), (40, 40, 0.5), (0, 40, 0.5)))
    corners = framing.clipped(blade, box)
    assert np.linalg.norm(geometry.vector_area(corners)) == pytest.approx(2)
    assert len(framing.clipped(Polygon(((2, 2, 2), (3, 2, 2), (3, 3, 2))), box)) == 0
