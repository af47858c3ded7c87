"""The table of all references of a suite, kept in references/README.md between two marks."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

BEGIN, END = "<!-- register -->\n", "<!-- end of register -->\n"
HEAD = ("scene", "case", "first engine", "second engine", "digits of agreement", "uncertainty", "source")


def table(folder: Path) -> str:
    """A Markdown table of every reference in a folder."""
    lines = [HEAD, ("---",) * len(HEAD)]
    for path in sorted(folder.glob("*.toml")):
        lines += _rows(path.stem, tomllib.loads(path.read_text(encoding="utf-8")))
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _rows(scene_id: str, about: dict[str, Any]) -> Iterator[tuple[str, ...]]:
    for name, case in about["cases"].items():
        yield (scene_id, name, case["engine"], case["second_engine"], _digits(case["agreement"]), f"{case['uncertainty']:.1e}",
               about["source"])


def _digits(agreement: float) -> str:
    if math.isnan(agreement):
        return "one engine"
    return f"{-math.log10(agreement):.1f}" if agreement else "all 16"


def refresh(folder: Path) -> None:
    """Write the table anew into the folder's README.md, where there is one with the two marks."""
    page = folder / "README.md"
    text = page.read_text(encoding="utf-8") if page.is_file() else ""
    if BEGIN in text and END in text:
        before, after = text.partition(BEGIN)[0], text.partition(END)[2]
        page.write_text(before + BEGIN + table(folder) + END + after, encoding="utf-8")
