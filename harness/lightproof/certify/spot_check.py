"""A stored reference against the first engine, at one element: cheap enough to do for a whole suite every night."""

from __future__ import annotations

from lightproof.certify.balls import CannotCertify
from lightproof.certify.engine import certify
from lightproof.references import Reference
from lightproof.scene import Scene

ROUNDING = 1e-3  # of its uncertainty: what binary64 may change of an estimate from one machine to another


def difference(scene: Scene, stored: Reference, element: int) -> str:
    """What is wrong with a stored element; empty where the first engine finds the same value, bit for bit unless it is an
    estimate, and is as sure."""
    try:
        found = certify(scene, [element])
    except CannotCertify as reason:
        return f"{scene.name}: {reason}"
    slack = ROUNDING * stored.uncertainty[element] if found.kind == "quadrature" else 0.0
    if abs(found.value[0] - stored.value[element]) > slack:
        return (f"{scene.name}: element {element} is stored as {stored.value[element]:.17g}, the first engine finds"
                f" {found.value[0]:.17g}")
    if found.uncertainty[0] > stored.uncertainty[element]:
        return (f"{scene.name}: element {element} is stored with uncertainty {stored.uncertainty[element]:.2g}, the first engine"
                f" is sure to {found.uncertainty[0]:.2g} only")
    return ""
