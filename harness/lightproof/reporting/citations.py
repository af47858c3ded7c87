"""Sources by their key in references/references.bib, as a reader wants them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ENTRY = re.compile(r"^@\w+\{\s*([^,\s]+)\s*,(.*?)^\}", re.MULTILINE | re.DOTALL)
FIELD = re.compile(r'^\s*(\w+)\s*=\s*(?:\{(.*)\}|"(.*)"|(\w+))\s*,?\s*$', re.MULTILINE)


@dataclass(frozen=True)
class Citation:
    """One source; `link` is empty where the bibliography names none."""

    text: str
    link: str = ""


def read(path: Path) -> dict[str, Citation]:
    """Every entry of a BibTeX file with one field a line; empty where there is no such file."""
    entries = ENTRY.findall(path.read_text(encoding="utf-8")) if path.is_file() else []
    return {key: _citation(_fields(body)) for key, body in entries}


def _fields(body: str) -> dict[str, str]:
    return {name.lower(): _plain("".join(values)) for name, *values in FIELD.findall(body)}


def _citation(fields: dict[str, str]) -> Citation:
    where = next((fields[name] for name in ("journal", "booktitle", "publisher", "institution", "school", "howpublished")
                  if name in fields), "")
    parts = (fields.get("author", ""), fields.get("title", ""), where, fields.get("year", ""))
    doi = fields.get("doi", "")
    link = f"https://doi.org/{doi}" if doi else fields.get("url", "")
    return Citation(". ".join(part.rstrip(".") for part in parts if part), link if link.startswith("https://") else "")


def _plain(value: str) -> str:
    return value.replace("{", "").replace("}", "").replace("--", "\N{EN DASH}").replace("\\&", "&")
