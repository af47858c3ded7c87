"""How many reflections a renderer has to follow."""

from __future__ import annotations

import math

from lightproof.scene import CameraFilm, Scene

MOST = 10_000  # reflections that a renderer without a limit of its own is made to follow
CUT = 1e-3  # of the tolerance: what the reflections beyond the last one may hold, where all are asked for
FAINT = 1e-3  # of its first weight: a path that is left with so little may be ended at random and hardly adds to the noise
SLACK = 0.1  # of the tolerance: the same where a renderer's limit comes first


def unsupported(scene: Scene, most: int = MOST) -> str | None:
    """Why a renderer that follows at most `most` reflections cannot follow those of a scene, or None."""
    needed = _needed(scene, SLACK)
    return f"{needed:,.0f} reflections matter here, and at most {most:,} are followed" if needed > most else None


def reflections(scene: Scene, most: int = MOST) -> int:
    """Reflections between emission and the film that a renderer has to follow; 0 where nothing reflects."""
    return int(min(_needed(scene, CUT), most))


def certain(scene: Scene) -> int:
    """Reflections that every path makes; after these it is faint, and roulette that keeps the expectation halves the cost."""
    largest = max((surface.reflectance for surface in scene.surfaces), default=0)
    return reflections(scene) if largest in (0, 1) else min(math.ceil(math.log(FAINT) / math.log(largest)), reflections(scene))


def edges(scene: Scene) -> int:
    """Edges of the longest light path from emitter to camera; a receiver under the camera counts as one more reflection."""
    return reflections(scene) + (1 if isinstance(scene.film, CameraFilm) else 2)


def _needed(scene: Scene, part: float) -> float:
    """`max_bounces`, or for "all" the n at which reflectance^n falls to `part` of the tolerance."""
    if not scene.reflects:
        return 0
    if scene.max_bounces != "all":
        return scene.max_bounces
    largest = max(surface.reflectance for surface in scene.surfaces)
    return math.inf if largest == 1 else math.ceil(math.log(part * min(scene.tolerance, 1)) / math.log(largest))
