"""The tables of a suite's references/README.md, each kept between two marks: every second engine, and every reference."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from lightproof.certify.second_engine import derivation, scenes_of

Row = tuple[str, ...]
SCRIPTS = ("second engine", "scenes", "derivation")
REFERENCES = ("scene", "case", "first engine", "second engine", "digits of agreement", "uncertainty", "source")


def scripts(folder: Path) -> str:
    """A Markdown table of every second engine in a folder."""
    found = sorted(folder.glob("*.py"))
    return _markdown(SCRIPTS, ((path.name, ", ".join(scenes_of(path)), derivation(path)) for path in found))


def references(folder: Path) -> str:
    """A Markdown table of every reference in a folder."""
    abouts = ((path.stem, tomllib.loads(path.read_text(encoding="utf-8"))) for path in sorted(folder.glob("*.toml")))
    return _markdown(REFERENCES, (row for scene_id, about in abouts for row in _rows(scene_id, about)))


def _rows(scene_id: str, about: dict[str, Any]) -> Iterator[Row]:
    for name, case in about["cases"].items():
        estimated = " (estimate)" if case["kind"] == "quadrature" else ""
        yield (scene_id, name, case["engine"] + estimated, case["second_engine"], _digits(case["agreement"]),
               f"{case['uncertainty']:.1e}", about["source"])


def _digits(agreement: float) -> str:
    if math.isnan(agreement):
        return "one engine"
    return f"{-math.log10(agreement):.1f}" if agreement else "all 16"


def _markdown(head: Row, rows: Iterable[Row]) -> str:
    return "".join(f"| {' | '.join(row)} |\n" for row in (head, ("---",) * len(head), *rows))


TABLES: dict[str, Callable[[Path], str]] = {"scripts": scripts, "register": references}


def refresh(folder: Path) -> None:
    """Write both tables anew into the folder's README.md, where there is one with their marks."""
    page = folder / "README.md"
    text = page.read_text(encoding="utf-8") if page.is_file() else ""
    for name, table in TABLES.items():
        begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->\n"
        if begin in text and end in text:
            text = text.partition(begin)[0] + begin + table(folder) + end + text.partition(end)[2]
    if text:
        page.write_text(text, encoding="utf-8")
