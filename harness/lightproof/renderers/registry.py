"""Every method that the harness knows by name. A dict, no import-time magic: the class is imported in the worker."""

from __future__ import annotations

import difflib
from collections.abc import Container, Iterable
from dataclasses import dataclass

from lightproof.checked import shown

OURS = "lightproof"  # the process of the in-house estimators


@dataclass(frozen=True)
class Entry:
    """`target` is module:class; methods with the same `worker` share a process; `extra` is what pip has to install; `python` is
    the path of the interpreter that the process runs under, empty for the harness's own."""

    name: str
    target: str
    worker: str
    extra: str = ""
    nightly: bool = False
    python: str = ""


def _ours(name: str, target: str, nightly: bool = False) -> Entry:
    return Entry(name, f"lightproof.estimators.{target}", worker=OURS, nightly=nightly)


def _sampling(name: str, target: str, quick: Container[str] = ()) -> list[Entry]:
    """A method that samples direct light, with each kind of points in both precisions; nightly but for `quick` options."""
    points = ("", "jitter", "lattice", "sobol")
    options = ["-".join(filter(None, (kind, precision))) for precision in ("", "float64") for kind in points]
    return [_ours(f"{name}/{option}" if option else name, target, nightly=option not in quick) for option in options]


def _apart(renderer: str, target: str, options: Iterable[str]) -> list[Entry]:
    """Configurations, each in a process of its own: Blender holds one file at a time, and Dr.Jit makes kernels for every object
    that is alive in a process, so that another configuration beside would cost a film of Mitsuba's 0.2 ms and 3 % of its time."""
    names = [f"{renderer}/{option}" for option in options]
    return [Entry(name, f"lightproof.renderers.{target}", worker=name, extra=renderer, nightly=True) for name in names]


def _radiance(option: str) -> Entry:
    return Entry(f"radiance/{option}", "lightproof.renderers.radiance:Radiance", "radiance", extra="radiance", nightly=True)


METHODS = {
    entry.name: entry
    for entry in (
        _ours("analytic", "analytic:Analytic"),
        _ours("riemann-area", "riemann_area:RiemannArea"),
        _ours("riemann-hemisphere", "riemann_hemisphere:RiemannHemisphere"),
        _ours("cubature", "cubature:Cubature", nightly=True),
        *_sampling("mc-area", "mc_area:McArea", quick=("", "sobol")),
        *_sampling("mc-hemisphere", "mc_hemisphere:McHemisphere"),
        *_sampling("mc-cosine", "mc_cosine:McCosine"),
        *_sampling("mc-solid-angle", "mc_solid_angle:McSolidAngle"),
        *_sampling("mc-projected-solid-angle", "mc_projected:McProjected"),
        *_sampling("mc-mis", "mc_mis:McMis"),
        _ours("path", "path:Path"),
        _ours("path/sobol", "path:Path", nightly=True),
        _ours("path/no-next-event", "path:Path", nightly=True),
        _ours("path/recursion", "path_recursion:PathRecursion"),
        _ours("textbook", "textbook:Textbook", nightly=True),
        _ours("textbook/float32", "textbook:Textbook", nightly=True),
        Entry("mitsuba", "lightproof.renderers.mitsuba:Mitsuba", worker="mitsuba", extra="mitsuba"),
        *_apart("mitsuba", "mitsuba:Mitsuba", ("scalar", "spectral", "independent", "stratified", "orthogonal", "sobol",
                                               "emitter-sampling", "mis", "path")),
        Entry("cycles", "lightproof.renderers.cycles:Cycles", worker="cycles", extra="cycles"),
        *_apart("cycles", "cycles:Cycles", ("lamp", "mesh", "light-tree", "blue-noise", "automatic")),
        Entry("luxcore", "lightproof.renderers.luxcore:LuxCore", worker="luxcore", extra="luxcore"),
        Entry("luxcore/random", "lightproof.renderers.luxcore:LuxCore", worker="luxcore", extra="luxcore", nightly=True),
        Entry("luxcore/bidirectional", "lightproof.renderers.luxcore:LuxCore", worker="luxcore", extra="luxcore", nightly=True),
        Entry("radiance", "lightproof.renderers.radiance:Radiance", worker="radiance", extra="radiance"),
        *map(_radiance, ("ambient-cache", "native-lamps", "quasi-random")),
        Entry("pyrender", "lightproof.renderers.pyrender:Pyrender", worker="pyrender", extra="pyrender"),
    )
}


def family(method: str) -> str:
    """The method that a configuration is one of."""
    return method.partition("/")[0]


def is_ours(method: str) -> bool:
    """Whether a method is one of the in-house estimators, and no renderer."""
    return method in METHODS and METHODS[method].worker == OURS


def unknown(name: str) -> str:
    """What to say of a name that no method has: which come closest, or else which families there are."""
    families = list(dict.fromkeys(map(family, METHODS)))
    close = difflib.get_close_matches(name, METHODS if "/" in name else families)
    advice = f"did you mean {' or '.join(close)}?" if close else f"there are {', '.join(families)}, some of them in several"
    tail = "'lightproof list' shows all" if close else "configurations that 'lightproof list' shows"
    return f"there is no method {shown(name)}; {advice} {tail}"
