"""What a renderer outside does wrong, with every job: `outside_faults.py MODE FAULT [JOB]`, or `--version`.

It knows more faults than outside_renderer.py, and those too.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import time

import outside_renderer
from outside_renderer import rendered, say


def misbehave(fault: str, job: dict, answer: dict) -> None:
    """Answer one job, or not."""
    if fault == "is-killed":
        print("more memory", file=sys.stderr, flush=True)
        os.kill(os.getpid(), signal.SIGKILL)
    elif fault == "fills-the-disk":
        with open(job["film"]["path"], "wb") as file:
            while True:
                file.write(bytes(1 << 16))
    elif fault == "answers-late":
        time.sleep(2)
        say(answer)
    elif fault == "hangs-after":
        say(answer)
        time.sleep(3600)
    elif fault in ALTERED:
        say(ALTERED[fault](answer))
    else:
        outside_renderer.misbehave(fault, job, answer)


ALTERED = {
    "infinite": lambda answer: json.dumps({**answer, "film": [7777, *answer["film"][1:]]}).replace("7777", "1e999"),
    "too-short": lambda answer: {**answer, "film": answer["film"][1:]},
    "of-another-scene": lambda answer: {**answer, "digest": "0" * 64},
    "of-another-job": lambda answer: {**answer, "job": "another"},
}


def main(mode: str, fault: str, file: str = "") -> None:
    if fault == "exits-at-once":
        sys.exit("no licence")
    if fault in ("starts-slowly", "hangs-before"):
        time.sleep(1 if fault == "starts-slowly" else 3600)
    requests = [open(file).read()] if mode == "once" else sys.stdin  # noqa: SIM115
    for line in requests:
        job = json.loads(line)
        misbehave(fault, job, rendered(job, ""))


if __name__ == "__main__":
    if sys.argv[1:] == ["--version"]:
        print("outside 1.0")
    else:
        main(*sys.argv[1:])
