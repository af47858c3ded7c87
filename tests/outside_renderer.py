"""A renderer outside, for tests: `outside_renderer.py MODE FAULT [JOB]`, or `--version`.

It imports nothing of Lightproof: it reads jobs and writes answers as examples/README.md has them, for one point light over
a plane, with relative noise of 0.2 / sqrt(samples). Its light is always wrong as FAULT says, or else it misbehaves as FAULT
says on every job of 13 samples.
"""

from __future__ import annotations

import json
import math
import os
import random
import signal
import subprocess
import sys
import time

UNLUCKY = 13


def light(scene: dict) -> list[float]:
    """Irradiance at the centre of each cell of a horizontal plane: I cos / r2 [W/m2]."""
    (lamp,), film = scene["light"], scene["film"]
    columns, rows = film["resolution"]
    values = []
    for row in range(rows):
        for column in range(columns):
            a, b = (column + 0.5) / columns, (row + 0.5) / rows
            frame = zip(lamp["position"], film["origin"], film["u"], film["v"], strict=True)
            way = [p - (o + a * u + b * v) for p, o, u, v in frame]
            values.append(lamp["intensity"] * way[2] / math.hypot(*way) ** 3)
    return values


def rendered(job: dict, fault: str) -> dict:
    """The honest answer, or one whose light is wrong."""
    about = {"job": job["job"], "digest": job["digest"]}
    scene = job["scene"]
    if [light["kind"] for light in scene["light"]] != ["point"] or scene["film"]["kind"] != "plane" or scene["surface"]:
        if fault != "declines-nothing":
            return {**about, "unsupported": "one point light over a plane, and nothing else"}
        return {**about, "film": [0.0] * (job["film"]["rows"] * job["film"]["columns"]), "samples": job["samples"]}
    draw = random.Random(0 if fault == "ignores-seed" else job["seed"])
    spent = 64 if fault == "ignores-samples" else job["samples"]
    exact = [math.pi * value if fault == "pi" else value for value in light(scene)]
    film = [value * (1 + draw.gauss(0, 0.2) / math.sqrt(spent)) for value in exact]
    variance = [(0.2 * value) ** 2 / (1 if fault == "undivided-variance" else spent) for value in exact]
    return {**about, "film": film, "samples": job["samples"], "variance": variance, "seconds": {"setup": 1e-4}}


def say(answer: object) -> None:
    print(answer if isinstance(answer, str) else json.dumps(answer), flush=True)


def misbehave(fault: str, job: dict, answer: dict) -> None:
    """Answer one job, or not."""
    if fault == "exits":
        sys.exit("out of photons \x1b[2J<script>")
    elif fault == "crashes":
        os.kill(os.getpid(), signal.SIGSEGV)
    elif fault == "fails-after":
        say(answer)
        sys.exit(4)
    elif fault == "hangs":
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        time.sleep(3600)
    elif fault == "closes-output":
        os.close(1)
        time.sleep(3600)
    elif fault == "floods":
        while True:
            os.write(1, b"light " * 10_000)
    elif fault == "floods-errors":
        while True:
            os.write(2, b"light " * 10_000)
    elif fault == "twice-later":
        say(answer)
        time.sleep(0.05)
        say(answer)
    elif fault == "leaves-a-child":
        child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(3600)"], start_new_session=True)
        with open(os.path.join(os.environ["TMPDIR"], f"child-{child.pid}"), "w"):
            say(answer)
    elif fault == "half-an-image":
        with open(job["film"]["path"], "wb") as file:
            file.write(b"v/1\x01\x02\x00\x00\x00channels")
        say({**answer, "film": "file"})
    else:
        say(ALTERED.get(fault, lambda answer: answer)(answer))


ALTERED = {
    "garbage": lambda answer: "Rendering: 100 % done",
    "twice": lambda answer: f"{json.dumps(answer)}\n{json.dumps(answer)}",
    "negative": lambda answer: {**answer, "film": [-1.0, *answer["film"][1:]]},
    "no-file": lambda answer: {**answer, "film": "file"},
}


def main(mode: str, fault: str, file: str = "") -> None:
    """Answer the job in a file, or those of standard input."""
    requests = [open(file).read()] if mode == "once" else sys.stdin  # noqa: SIM115
    for line in requests:
        job = json.loads(line)
        misbehave(fault if job["samples"] == UNLUCKY else "", job, rendered(job, fault))


if __name__ == "__main__":
    if sys.argv[1:] == ["--version"]:
        print("outside 1.0")
    else:
        main(*sys.argv[1:])
