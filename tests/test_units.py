"""Each renderer renders known lights with awkward values, and what it gives is compared with closed forms written here.

One per cent notices every factor that a unit can hide (pi, 4/pi, 2, 4 pi, 1/pi). pyrender gets ten, and no grazing
light: its surface is not the Lambert surface that it is taken for. The smallest of those factors costs 21.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import one_process
import pytest
from one_process import Shot

from lightproof import scene_file

WITHIN = {"mitsuba": 0.01, "mitsuba/scalar": 0.01, "cycles": 0.01, "pyrender": 0.10}
SAMPLES = 1024
FLOOR, SLOPE = (0.0, 0.0, 1.0), (0.0, -0.6, 0.8)
HERE, THERE = np.array([0.21, -0.34, 0.05]), np.array([-0.47, 0.26, 0.05])
RECTANGLE = np.array([[-0.2, -0.9, 1.3], [-0.2, 0.4, 1.3], [0.5, 0.4, 1.3], [0.5, -0.9, 1.3]])
TRIANGLE = np.array([[-0.62, -0.31, 1.21], [0.18, 0.73, 1.67], [0.84, -0.37, 0.93]])


def polygon(corners: np.ndarray, radiance: float, point: np.ndarray, normal: Any) -> float:
    """Irradiance [W/m2] of a polygon wholly above the receiver's horizon (Lambert 1760)."""
    spokes = (corners - point) / np.linalg.norm(corners - point, axis=1, keepdims=True)
    following = np.roll(spokes, -1, axis=0)
    axes = np.cross(following, spokes)
    sines = np.linalg.norm(axes, axis=1)
    angles = np.arctan2(sines, (spokes * following).sum(axis=1))
    return float(radiance / 2 * (angles / sines * (axes @ np.array(normal))).sum())


def bulb(intensity: float, position: Any, point: np.ndarray, normal: Any) -> Any:
    """Irradiance [W/m2] of a point light at points (..., 3)."""
    way = np.array(position) - point
    return intensity * (way @ np.array(normal)) / np.linalg.norm(way, axis=-1) ** 3


def at_points(light: dict[str, Any], normal: Any = FLOOR) -> dict[str, Any]:
    points = {"positions": [HERE.tolist(), THERE.tolist()], "normals": [list(normal)] * 2}
    return described([light], (), {"kind": "points", "quantity": "irradiance", **points}, 0)


def described(lights: list, surfaces: Any, film: dict[str, Any], bounces: int | str) -> dict[str, Any]:
    return {"title": "Known light", "max_bounces": bounces, "tolerance": 0.01, "film": film,
            "light": [{"id": "lamp", **light} for light in lights], "surface": list(surfaces)}


def area(shape: dict[str, Any], radiance: float) -> dict[str, Any]:
    return {"kind": "area", "shape": shape, "radiance": radiance}


def flat(corners: np.ndarray) -> dict[str, Any]:
    return {"type": "polygon", "vertices": corners.tolist()}


def over_both(light: Any) -> list[float]:
    return [light(HERE), light(THERE)]


def cell_means(intensity: float, position: Any, film: dict[str, Any], fine: int = 64) -> np.ndarray:
    """Mean irradiance of a point light over the cells of a plane film, by the midpoint rule on fine x fine points a cell."""
    (columns, rows), origin, u, v = (film[key] for key in ("resolution", "origin", "u", "v"))
    a, b = (np.arange(columns * fine) + 0.5) / (columns * fine), (np.arange(rows * fine) + 0.5) / (rows * fine)
    points = np.array(origin) + a[None, :, None] * np.array(u) + b[:, None, None] * np.array(v)
    normal = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    return bulb(intensity, position, points, normal).reshape(rows, fine, columns, fine).mean(axis=(1, 3)).ravel()


CAMERA = {"kind": "camera", "quantity": "radiance", "projection": "perspective", "origin": [0.3, -1.9, 0.9],
          "target": [0.1, 0.2, 0.0], "up": [0, 0, 1], "fov": 23, "resolution": [6, 4]}
GROUND = {"id": "ground", "reflectance": 0.37, "shape": flat(50 * np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]))}
WALL = {"id": "wall", "shape": {"type": "sphere", "center": [0.3, -1.6, 0.7], "radius": 1.7}, "side": "inside",
        "reflectance": 0.6, "radiance": 0.83}
CELLS = {"kind": "plane", "quantity": "irradiance", "origin": [-0.7, -0.4, 0.1], "u": [1.5, 0, 0], "v": [0, 0.72, 0.54],
         "resolution": [5, 4]}
SQUARES = {**CELLS, "resolution": [5, 3]}
POINT = {"kind": "point", "position": [0.31, -0.62, 1.2], "intensity": 2.9}

DISK = {"type": "disk", "center": [0.21, -0.34, 1.18], "normal": [0, 0, -3], "radius": 0.37}
SPHERE = {"type": "sphere", "center": [0.21, -0.34, 1.42], "radius": 0.31}
TUBE = {"type": "cylinder", "base": [0.21, -0.54, 9.05], "axis": [0, 1, 0], "height": 0.4, "radius": 0.07}

KNOWN: dict[str, tuple[dict[str, Any], Any]] = {
    "rectangle": (at_points(area(flat(RECTANGLE), 2.04)), over_both(lambda p: polygon(RECTANGLE, 2.04, p, FLOOR))),
    "rectangle-tilted": (at_points(area(flat(RECTANGLE), 2.04), SLOPE), over_both(lambda p: polygon(RECTANGLE, 2.04, p, SLOPE))),
    "rectangle-from-behind": (at_points(area(flat(RECTANGLE[::-1]), 2.04)), [0, 0]),
    "triangle": (at_points(area(flat(TRIANGLE), 3.7)), over_both(lambda p: polygon(TRIANGLE, 3.7, p, FLOOR))),
    "disk": (at_points(area(DISK, 4.3)), [np.pi * 4.3 * 0.37**2 / (1.13**2 + 0.37**2), None]),
    "sphere": (at_points(area(SPHERE, 3.1)), [np.pi * 3.1 * (0.31 / 1.37) ** 2, None]),
    "tube": (at_points(area(TUBE, 950.0)), [950 * 0.4 * 0.14 / 9**2, None]),  # length x width / r2, seen from afar
    "point": (at_points(POINT), over_both(lambda p: bulb(2.9, POINT["position"], p, FLOOR))),
    "point-cells": (described([POINT], (), CELLS, 0), cell_means(2.9, POINT["position"], CELLS)),
    "point-squares": (described([POINT], (), SQUARES, 0), cell_means(2.9, POINT["position"], SQUARES)),
    "beam": (at_points({"kind": "directional", "direction": [0, 0.9, -1.2], "irradiance": 5.7}), [5.7 * 0.8] * 2),
    "beam-tilted": (at_points({"kind": "directional", "direction": [0, 0.9, -1.2], "irradiance": 5.7}, SLOPE), [5.7] * 2),
    "sky": (at_points({"kind": "environment", "radiance": 1.37}, SLOPE), [np.pi * 1.37] * 2),
    "half-sky": (at_points({"kind": "environment", "radiance": 1.37, "extent": "upper"}, SLOPE), [np.pi * 1.37 * 0.9] * 2),
    "sky-seen": (described([{"kind": "environment", "radiance": 1.37}], (), CAMERA, 0), [1.37] * 24),
    "ground-in-sky": (described([{"kind": "environment", "radiance": 1.37}], [GROUND], CAMERA, 1), [1.37 * 0.37] * 24),
    "furnace": (described([], [WALL], CAMERA, "all"), [0.83 / 0.4] * 24),
    "furnace-cut": (described([], [WALL], CAMERA, 3), [0.83 * (1 - 0.6**4) / 0.4] * 24),
}


@pytest.fixture(scope="module", params=WITHIN)
def films(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, dict[str, Any]]:
    """The films of all known lights, from one process of the renderer."""
    shots = [Shot(scene_file.from_table(table, name), SAMPLES) for name, (table, _) in KNOWN.items()]
    films = one_process.render(request.param, shots, tmp_path_factory.mktemp("units"))
    return request.param, dict(zip(KNOWN, films, strict=True))


@pytest.mark.parametrize("name", KNOWN)
def test_known_light(films: tuple[str, dict[str, Any]], name: str) -> None:
    """A light of known value, given as each renderer takes it: the film is that of the closed form. What a renderer says
    it cannot do, it does not do by half."""
    method, rendered = films
    answer, expected = rendered[name], KNOWN[name][1]
    if "unsupported" in answer:
        assert method == "pyrender"
        return
    for element, value in zip(answer["film"], expected, strict=True):
        if value is not None:
            assert element == pytest.approx(value, rel=WITHIN[method], abs=1e-12)


def test_what_pyrender_can_do(films: tuple[str, dict[str, Any]]) -> None:
    """pyrender does point lights, beams and a uniform sky, and nothing else here; the other renderers do everything."""
    method, rendered = films
    done = {name for name, answer in rendered.items() if "film" in answer}
    assert done == ({"point", "point-squares", "beam", "beam-tilted", "sky"} if method == "pyrender" else set(KNOWN))
