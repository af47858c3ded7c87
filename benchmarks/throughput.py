"""Samples per second and efficiency of in-house estimators beside any renderer, interleaved on the same machine.

    python benchmarks/throughput.py --methods mc-area,path,mitsuba --scenes square-light,occluded-square --rounds 7
"""

from __future__ import annotations

import argparse
import importlib
import os
import statistics
import time

import pandas as pd

from lightproof import suite
from lightproof.method import Method, Unavailable
from lightproof.renderers.registry import METHODS
from lightproof.scene import Scene

TARGET = 0.25  # seconds of one film


def main() -> None:
    options = arguments()
    rows = [row for name in options.scenes.split(",") for row in race(suite.default().scene(name), options)]
    print(pd.DataFrame(rows).to_string(index=False, float_format="{:.4g}".format))


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--methods", default="mc-area,mc-cosine,path,mitsuba")
    parser.add_argument("--scenes", default="square-light,occluded-square")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    return parser.parse_args()


def race(scene: Scene, options: argparse.Namespace) -> list[dict]:
    """One row per method: the median over rounds, in each of which every method renders one film in turn."""
    runners = {name: made for name in options.methods.split(",") if (made := ready(name, scene, options.threads))}
    counts = {name: samples_in_time(made) for name, made in runners.items()}
    rates: dict[str, list[float]] = {name: [] for name in runners}
    for seed in range(1, options.rounds + 1):
        for name, made in runners.items():
            rates[name].append(rate(made, counts[name], seed) * scene.size)
    return [
        {"scene": scene.name, "method": name, "samples": counts[name], "million samples/s": statistics.median(values) / 1e6,
         "slowest": min(values) / 1e6, "fastest": max(values) / 1e6}
        for name, values in rates.items()
    ]


def ready(name: str, scene: Scene, threads: int) -> Method | None:
    """The method with the scene prepared; None, with a word on why, where it cannot."""
    module, cls = METHODS[name].target.split(":")
    made = getattr(importlib.import_module(module), cls)(name, threads)
    try:
        made.open()
    except Unavailable as error:
        return print(f"{name}: {error}")
    reason = made.unsupported(scene)
    if reason:
        return print(f"{scene.name}, {name}: unsupported: {reason}")
    made.prepare(scene)
    return made


def samples_in_time(made: Method) -> int:
    """Samples per element that take about TARGET seconds: the first power of 4 that does, after a first film."""
    samples = 16
    made.render(samples, 1)
    while samples < 4**14 and samples / rate(made, samples, 1) < TARGET:
        samples *= 4
    return samples


def rate(made: Method, samples: int, seed: int) -> float:
    """Samples per element and second of one film."""
    start = time.perf_counter()
    drawn = made.render(samples, seed).samples
    return drawn / (time.perf_counter() - start)


if __name__ == "__main__":
    main()
