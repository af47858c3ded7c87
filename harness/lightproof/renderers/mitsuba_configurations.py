"""The ways in which Mitsuba is run: variant, sampler, and how light is looked for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from lightproof.geometry import Sphere
from lightproof.renderers import transport
from lightproof.scene import Environment, Scene

LEAN, EMITTERS, BOTH, PATH = "lean", "emitters", "both", "path"


@dataclass(frozen=True)
class Configuration:
    """`search`: for the light of one reflection, LEAN samples emitters, or directions where light comes from all of them;
    EMITTERS only emitters; BOTH combines the two; PATH leaves even that to the path tracer, which combines them too."""

    variant: str = "llvm_ad_mono"
    sampler: str = "multijitter"
    search: str = LEAN


CONFIGURATIONS = {
    "": Configuration(),
    "scalar": Configuration(variant="scalar_rgb"),
    "spectral": Configuration(variant="llvm_ad_spectral"),
    "independent": Configuration(sampler="independent"),
    "stratified": Configuration(sampler="stratified"),
    "orthogonal": Configuration(sampler="orthogonal"),
    "sobol": Configuration(sampler="ldsampler"),  # the first two dimensions of Sobol's sequence, scrambled and shuffled
    "emitter-sampling": Configuration(search=EMITTERS),
    "mis": Configuration(search=BOTH),
    "path": Configuration(search=PATH),
}


def unsupported(scene: Scene, search: str) -> str | None:
    """Why light cannot be looked for in this way, or None."""
    if search == EMITTERS and transport.edges(scene) > 2:
        return "Mitsuba follows reflections only by its path tracer, which samples directions too"
    return None


def integrator(scene: Scene, search: str = LEAN) -> dict[str, Any]:
    """Emitters alone: the path tracer cut at its first vertex. One reflection: the direct integrator, as `search` says. More:
    the path tracer, without Russian roulette."""
    depth = transport.edges(scene)
    if depth != 2 or search == PATH:
        return {"type": "path", "max_depth": depth, "rr_depth": depth + 1}
    emitters, directions = {LEAN: _lean(scene), EMITTERS: (True, False), BOTH: (True, True)}[search]
    return {"type": "direct", "emitter_samples": int(emitters), "bsdf_samples": int(directions)}


def caveat(scene: Scene, integrator: dict[str, Any]) -> str:
    """What is wrong with an integrator on a scene, or nothing."""
    inward = [surface for surface in scene.surfaces if surface.radiance and surface.side == "inside"]
    if _combines(integrator) and any(isinstance(surface.shape, Sphere) for surface in inward):
        return ("Mitsuba's multiple importance sampling is biased inside an analytic sphere that emits: emitter sampling"
                " alone and BSDF sampling alone are right, their combination is too bright, more so far from the origin.")
    return ""


def _combines(integrator: dict[str, Any]) -> bool:
    """Whether emitters and directions are both sampled: multiple importance sampling."""
    return integrator["type"] == "path" or integrator["emitter_samples"] * integrator["bsdf_samples"] > 0


def _lean(scene: Scene) -> tuple[bool, bool]:
    """Whether to sample emitters, and whether directions: what light comes from all around is found by direction."""
    emitters = [*scene.lights, *(surface for surface in scene.surfaces if surface.radiance)]
    around = [isinstance(emitter, Environment) or getattr(emitter, "side", "") == "inside" for emitter in emitters] or [True]
    return not all(around), any(around)
