"""Where a run takes place: processor, memory, versions, the state of the source."""

from __future__ import annotations

import os
import platform
import subprocess
from importlib import metadata
from pathlib import Path

import numpy as np
import psutil


def description() -> str:
    """Processor, cores, memory and system in a line."""
    memory = psutil.virtual_memory().total / 1e9
    system = f"{platform.system()} {platform.release()} {platform.machine()}"
    return f"{_processor()}, {usable_cores()} cores, {memory:.0f} GB, {system}"


def usable_cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def versions() -> dict[str, str]:
    """Of the harness and what it computes with."""
    return {"lightproof": metadata.version("lightproof"), "python": platform.python_version(), "numpy": np.__version__}


def commit() -> str:
    """The checkout's commit, with a + where files differ from it; empty for an installed copy."""
    folder = Path(__file__).resolve().parents[2]
    try:
        git = ["git", "-C", str(folder), "describe", "--always", "--abbrev=12", "--dirty=+", "--exclude=*"]
        return subprocess.run(git, capture_output=True, text=True, check=True, timeout=10).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return ""


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()
