"""Exact point values per second of the first reference engine, one light of each shape above the same receivers.

    python benchmarks/certify.py --points 2000 --rounds 5
"""

from __future__ import annotations

import argparse
import statistics
import time

import numpy as np
import pandas as pd

from lightproof import scene_file
from lightproof.certify.engine import certify
from lightproof.scene import Scene

LIGHTS = {
    "rectangle": {"vertices": [[-0.4, -0.7, 1.3], [-0.4, 0.3, 1.3], [0.6, 0.3, 1.3], [0.6, -0.7, 1.3]]},
    "disk": {"center": [0.1, 0.2, 1.1], "normal": [0, 0, -1], "radius": 0.3},
    "sphere": {"center": [0.1, 0.2, 1.1], "radius": 0.3},
}


def main() -> None:
    options = arguments()
    receivers = np.random.default_rng(1).uniform([-1, -1, 0], [1, 1, 0], (options.points, 3))
    scenes = {name: above(light, receivers) for name, light in lights().items()}
    rates: dict[str, list[float]] = {name: [] for name in scenes}
    for _ in range(options.rounds):
        for name, scene in scenes.items():
            rates[name].append(rate(scene))
    rows = [{"light": name, "points/s": statistics.median(each), "slowest": min(each), "fastest": max(each)}
            for name, each in rates.items()]
    print(pd.DataFrame(rows).to_string(index=False, float_format="{:,.0f}".format))


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=2000)
    parser.add_argument("--rounds", type=int, default=5)
    return parser.parse_args()


def lights() -> dict[str, dict]:
    """The table of each light."""
    area = {name: {"kind": "area", "radiance": 2.04, "shape": {"type": "polygon" if "vertices" in shape else name, **shape}}
            for name, shape in LIGHTS.items()}
    return {**area, "point": {"kind": "point", "intensity": 2.04, "position": [0.1, 0.2, 1.1]}}


def above(light: dict, receivers: np.ndarray) -> Scene:
    """One light over receivers (n, 3) that look up."""
    film = {"kind": "points", "quantity": "irradiance", "positions": receivers.tolist(), "normals": [[0, 0, 1]] * len(receivers)}
    table = {"title": "one light", "max_bounces": 0, "tolerance": 0.005, "light": [{"id": "lamp", **light}], "film": film}
    return scene_file.from_table(table, "one-light")


def rate(scene: Scene) -> float:
    """Elements per second."""
    start = time.perf_counter()
    certify(scene)
    return scene.size / (time.perf_counter() - start)


if __name__ == "__main__":
    main()
