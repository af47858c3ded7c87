"""Lightproof: is a renderer's light right, and what does it cost?

In a notebook: `load`, `render`, `reference`, `judge`. They are imported when first used, so that a worker process, which
needs none of them, starts fast and never loads a reference.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__all__ = ["judge", "load", "reference", "render"]


def __getattr__(name: str) -> Any:
    if name in __all__:
        return getattr(import_module("lightproof.api"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
