"""write a scene in another tool's own format, to be opened and rendered there by hand"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from lightproof import exporting, suite
from lightproof.cli import selection
from lightproof.cli.status import DONE, INCOMPLETE, UsageError
from lightproof.exporting import TOOLS, CannotExport
from lightproof.method import Unavailable
from lightproof.suite import Suite


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which scene, for which tool, where to."""
    add = parser.add_argument
    add("scene", metavar="SCENE", help="id, id:case or path of a .toml file")
    add("--to", required=True, choices=sorted(TOOLS), help="the tool")
    add("--out", type=Path, metavar="PATH", help="the main file, or a folder for it (default: here, named after the scene)")
    add("--suite", type=Path, metavar="DIR", help="a folder with scenes/ (default: Lightproof's own)")


def run(options: argparse.Namespace) -> int:
    """Write the file and print its path; 3 where the tool cannot hold the scene, or is needed and not installed."""
    home = Suite(options.suite) if options.suite else suite.default()
    (scene,) = selection.scenes([options.scene], [], home)
    path = _place(options.out or Path(), f"{scene.name.replace(':', '-')}{TOOLS[options.to].suffix}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        exporting.write(scene, options.to, path)
    except (CannotExport, Unavailable) as reason:
        print(f"lightproof export: {scene.name} cannot be written for {options.to}: {reason}", file=sys.stderr)
        return INCOMPLETE
    except OSError as error:
        raise UsageError(f"{path}: cannot be written ({error.strerror}); give a path that can, with --out") from None
    print(path)
    return DONE


def _place(out: Path, name: str) -> Path:
    return out / name if out.is_dir() or not out.suffix else out
