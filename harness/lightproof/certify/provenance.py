"""What a reference's formula is and where it comes from."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Provenance:
    """`formula` for a reader, `source` in one sentence, `citations` as keys of references.bib."""

    formula: str
    source: str
    citations: tuple[str, ...]


SPHERE_THEOREM = "Inside a sphere the form factor to an area dA is dA/(4 π r²) from everywhere (the integrating sphere)."

POLYGON = Provenance(
    "E = (L/2) Σ θᵢ (gᵢ · n): half the sum, over the polygon's edges, of the angle θᵢ that an edge subtends times the cosine"
    " between the plane of that angle and the receiver",
    "Lambert's formula for polygons, as Arvo gives it.",
    ("lambert1760", "arvo1995"),
)
SHADOW = Provenance(
    "E = (L/2) Σ θᵢ (gᵢ · n) over the edges of what the receiver sees of the light past the blocker",
    "Lambert's formula on the visible part of the light, as in Arvo 1994.",
    ("lambert1760", "arvo1994"),
)
DISK = Provenance(
    "E = (π L/2) [1 − (h² + a² − r²)/√((h² + a² + r²)² − 4 r² a²)] for a parallel disk; the same contour integral if tilted",
    "Lambert's contour integral around a circle; the parallel disk is in Howell's catalogue.",
    ("lambert1760", "howell"),
)
OUTLINES = Provenance(
    "E = (L/2) ∮ ((y − x) × dy) · n / |y − x|² around what is seen of the light: straight edges and arcs of circles, cut where"
    " they are seen to cross",
    "Lambert's contour integral along straight edges, rims and silhouettes, each elementary; as in Arvo 1994, with curves.",
    ("lambert1760", "arvo1994"),
)
DISK_SHADOW = Provenance(
    "E = (L/2) ∮ ((y − x) × dy) · n / |y − x|² around what is seen of the light: arcs of the light's rim and of the blocker's",
    "Lambert's contour integral along circular arcs, integrated over the distance from the common axis.",
    ("lambert1760", "arvo1994"),
)
SPHERE = Provenance(
    "E = π L (R/d)² cos θ where the sphere is whole; cut by the horizon,"
    " E = L [(R/d)² (cos θ acos y − x sin θ √(1 − y²)) + atan(sin θ √(1 − y²)/x)], x = √(d²/R² − 1), y = −x cot θ",
    "Snyder 1996 for the sphere cut by the horizon; the whole sphere is in Howell's catalogue.",
    ("snyder1996", "howell"),
)
POINT = Provenance("E = I cos θ / r²", "The inverse square and cosine laws.", ("lambert1760",))
BEAM = Provenance("E = E₀ cos θ", "The cosine law.", ("lambert1760",))
POINT_SHADOW = Provenance(
    "E = I cos θ / r² where nothing stands between, else 0",
    "The inverse square and cosine laws; the shadow's edges are cut out exactly.",
    ("lambert1760",),
)
BEAM_SHADOW = Provenance(
    "E = E₀ cos θ where nothing stands between, else 0",
    "Over a film the hard edges of a beam's shadow are cut out exactly.",
    ("lambert1760",),
)
SKY = Provenance(
    "E = π L under a whole sphere of sky; E = π L (1 + cos b)/2 on a plane tilted by b under its upper half",
    "The integral of L cos θ over the visible sky; the tilted plane is in Howell's catalogue.",
    ("howell",),
)
OVERCAST = Provenance(
    "E = (L_z/3) [π (1 + cos b)/2 + (4/3) ((π − b) cos b + sin b)] on a plane tilted by b",
    "The integral of L_z (1 + 2 sin γ)/3 cos θ over the visible sky; that sky is Moon and Spencer's.",
    ("moon1942",),
)
SEEN = Provenance(
    "L = the lamp's own; 0 behind; ρ E/π where a surface reflects: averaged over each pixel, by the area that each part takes",
    "Radiance is the same all along a ray (Nicodemus 1963); outlines are cut in exact numbers.",
    ("nicodemus1963",),
)
BALL_SEEN = Provenance(
    "L_e + ρ L on the ball, L beside it: in a pixel, by the share of its area that the ball's outline encloses",
    "Nothing convex lights itself: under a uniform sky it receives π L everywhere; radiance is the same all along a ray.",
    ("lambert1760", "nicodemus1963"),
)
GLOW = Provenance("L = L_e (1 + ρ + ρ² + …) = L_e/(1 − ρ), E = π L", SPHERE_THEOREM, ("jacquez1955",))
LIT_SPHERE = Provenance(
    "E = I (r − c cos γ)/(r² + c² − 2 r c cos γ)^(3/2) + ρ I/(r² (1 − ρ)), L = ρ E/π", SPHERE_THEOREM, ("jacquez1955",))


def joined(parts: Iterable[Provenance], then: str = "") -> Provenance:
    """Several provenances as one, each mentioned once; `then` ends the formula."""
    once = list(dict.fromkeys(parts))
    return Provenance("; ".join(part.formula for part in once) + then, " ".join(part.source for part in once),
                      tuple(dict.fromkeys(key for part in once for key in part.citations)))
