"""Import a renderer, or say in one line what would make it importable."""

from __future__ import annotations

import importlib
from types import ModuleType

from lightproof.method import Unavailable


def renderer(module: str, extra: str) -> ModuleType:
    """The module of a renderer that `pip install 'lightproof[extra]'` brings. Raises Unavailable."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError:
        raise missing(module, extra) from None
    except ImportError as error:
        raise Unavailable(f"{module} lacks a system library ({error}): install what apt-packages.txt lists") from None


def missing(package: str, extra: str) -> Unavailable:
    """What to do about a Python package that is not there."""
    return Unavailable(f"{package} is not installed: pip install 'lightproof[{extra}]'")
