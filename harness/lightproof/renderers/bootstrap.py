"""Starts a worker under any interpreter: `python bootstrap.py ARGUMENTS`.

The package is the one that this file lies in, wherever the interpreter would look for another: only its own folder is
given, never the packages beside it, which may be built for another Python.
"""

import sys
from importlib import util
from pathlib import Path

OLDEST = (3, 11)


def complaint() -> str:
    """What keeps a worker from running under this interpreter, and what to do about it; else empty."""
    if sys.version_info < OLDEST:
        return f"{sys.executable} is Python {sys.version.split()[0]}; give one of {'.'.join(map(str, OLDEST))} or later"
    missing = not all(map(util.find_spec, ("numpy", "OpenEXR")))
    return f"{sys.executable} lacks numpy or OpenEXR: {sys.executable} -m pip install numpy OpenEXR" if missing else ""


def package() -> None:
    """Make `lightproof` the package around this file."""
    spec = util.spec_from_file_location("lightproof", Path(__file__).parents[1] / "__init__.py")
    sys.modules["lightproof"] = util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules["lightproof"])


if __name__ == "__main__":
    sys.path[0] = ""  # the current folder, not the adapters beside this file, which are named as their renderers
    if complaint():
        sys.exit(complaint())
    package()
    from lightproof.renderers import worker

    worker.main(*map(int, sys.argv[1:]))
