"""Imports go one way, and the judge and the judged share nothing but the scene."""

from __future__ import annotations

import ast
from pathlib import Path

import lightproof

SOURCE = Path(lightproof.__file__).parent

LAYERS = [
    {"checked", "quiet"},
    {"radiometry", "geometry", "statistics", "typed"},
    {"lights", "receivers"},
    {"scene"},
    {"scene_file", "exr"},
    {"trial", "references", "films", "method", "sketch"},
    {"suite", "certify", "estimators"},
    {"renderers"},
    {"store", "diagnose", "scale", "exporting"},
    {"ladder"},
    {"finding", "grading", "rightness"},
    {"verdict", "runner"},
    {"judging", "machine"},
    {"plan"},
    {"baseline", "reporting", "conformance"},
    {"gate", "api"},
    {"checking"},
    {"cli", "pytest_plugin"},
]


def imports(path: Path) -> set[str]:
    """The modules of the package that a file imports, by their first name."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [f"{node.module}.{alias.name}" for alias in node.names] if node.module == "lightproof" else [node.module]
        found |= {name.split(".")[1] for name in names if name.startswith("lightproof.")}
    return found


def modules() -> dict[str, set[str]]:
    """First name of each module or sub-package -> first names of what it imports."""
    found: dict[str, set[str]] = {}
    for path in SOURCE.rglob("*.py"):
        name = path.relative_to(SOURCE).parts[0].removesuffix(".py")
        found.setdefault(name, set()).update(imports(path) - {name})
    return found


def test_imports_go_one_way():
    rank = {name: level for level, layer in enumerate(LAYERS) for name in layer}
    for module, imported in modules().items():
        if module == "__init__":
            continue
        assert module in rank, f"{module} has no layer"
        for name in imported:
            assert rank[name] < rank[module], f"{module} imports {name}"


def test_the_judged_never_see_a_reference():
    """Estimators, renderers and the runner load no reference; the reference engine imports no estimator."""
    imported = modules()
    for judged in ("estimators", "renderers", "runner", "method", "films", "trial"):
        assert not imported[judged] & {"references", "suite", "certify", "verdict", "reporting"}, judged
    assert imported["certify"] <= {"checked", "geometry", "scene", "scene_file", "radiometry", "references", "suite"}
