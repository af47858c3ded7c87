"""Where on a film the visible shape of a polygon light changes: lines, and behind several blockers conics.

A corner of the light passes behind an edge of a blocker, or an edge of it behind a corner; a blocker's corner behind another's
edge; edges of two blockers and of the light, or of three blockers, cross in one point. Low corners and edges of the light add
lines that crowd around them, between which the light changes little.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations, permutations

import numpy as np

from lightproof import geometry
from lightproof.estimators.sheet import EVERYWHERE, Sheet

FLAT = 1e-12  # of a size: what lies no farther from a plane lies in it
SPREAD = 3.0  # from one line of a crowd to the next
LEAST = 1e-6  # of an element: the finest crowd
MARGIN = 1e-6  # of a film: added to what bounds a curve

Loop = np.ndarray  # corners (m, 3)


def curves(sheet: Sheet, light: Loop, blockers: Sequence[Loop]) -> list[np.ndarray]:
    """Rows of curves of one light behind blockers."""
    light = above(light, sheet.normal, sheet.center)
    if len(light) < 3:
        return []
    face = geometry.unit(geometry.vector_area(light))
    between = [above(above(loop, sheet.normal, sheet.center), face, light[0]) for loop in blockers]
    solid = [loop for loop in between if len(loop) > 2]
    reach = [shadow_box(sheet, light, loop) for loop in solid]
    faces = sheet.lines(np.array([face, *map(geometry.vector_area, solid)]), np.array([light[0], *(loop[0] for loop in solid)]))
    rows = [faces, *crowds(sheet, light), *(touching(sheet, loop) for loop in solid)]
    for loop, box in zip(solid, reach, strict=True):
        rows += [passing(sheet, light, edges(loop), box), passing(sheet, loop, edges(light), box)]
    for (one, box), (other, second) in combinations(zip(solid, reach, strict=True), 2):
        rows += list(pair(sheet, light, one, other, shared(box, second)))
    for trio in combinations(zip(solid, reach, strict=True), 3):
        box = shared(shared(trio[0][1], trio[1][1]), trio[2][1])
        if not empty(box):
            rows.append(triple(sheet, *(edges(loop) for loop, _ in trio), box))
    return rows


def above(loop: Loop, normal: np.ndarray, point: np.ndarray) -> Loop:
    """The part of a polygon in front of a plane; (0, 3) where none is, but for rounding."""
    levels = (loop - point) @ normal
    if not len(loop) or levels.max() <= FLAT * max(np.abs(loop).max(), np.abs(point).max()):
        return np.zeros((0, 3))
    kept = []
    for i, (level, corner) in enumerate(zip(levels, loop, strict=True)):
        if levels[i - 1] * level < 0:
            kept.append(loop[i - 1] + (corner - loop[i - 1]) * (levels[i - 1] / (levels[i - 1] - level)))
        if level >= 0:
            kept.append(corner)
    return np.array(kept)


def edges(loop: Loop) -> np.ndarray:
    """(m, 2, 3)."""
    return np.stack([loop, np.roll(loop, -1, axis=0)], axis=1)


def shadow_box(sheet: Sheet, upper: np.ndarray, lower: np.ndarray) -> np.ndarray:
    """The box (..., 4) around all shadows of points `lower` (..., l, 3) in the light of points `upper` (..., k, 3); without
    bounds where one of the upper ones is not higher than all of the lower."""
    up, low = sheet.height(upper)[..., :, None], sheet.height(lower)[..., None, :]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (up / (up - low))[..., None]
        places = sheet.places(upper)[..., :, None, :] * (1 - share) + sheet.places(lower)[..., None, :, :] * share
    bounded = (up > low).all(axis=(-1, -2))[..., None]
    lowest, highest = places.min(axis=(-3, -2)) - MARGIN, places.max(axis=(-3, -2)) + MARGIN
    box = np.stack([lowest[..., 0], highest[..., 0], lowest[..., 1], highest[..., 1]], axis=-1)
    return np.where(bounded, box, EVERYWHERE)


def shared(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """What boxes (..., 4) have in common."""
    low, high = np.maximum(one[..., ::2], other[..., ::2]), np.minimum(one[..., 1::2], other[..., 1::2])
    return np.stack([low[..., 0], high[..., 0], low[..., 1], high[..., 1]], axis=-1)


def empty(box: np.ndarray) -> bool:
    return bool(box[0] > min(box[1], 0.5) or box[2] > min(box[3], 0.5) or box[1] < -0.5 or box[3] < -0.5)


def passing(sheet: Sheet, corners: np.ndarray, sides: np.ndarray, within: np.ndarray) -> np.ndarray:
    """Lines from which a corner (k, 3) is seen on an edge (l, 2, 3): within the edge's shadow in the light of the corner, or the
    other way round where the corner is the lower one."""
    corner = np.repeat(corners, len(sides), axis=0)
    side = np.tile(sides, (len(corners), 1, 1))
    normals = np.cross(side[:, 0] - corner, side[:, 1] - corner)
    higher = sheet.height(corner) > sheet.height(side).max(axis=1)
    boxes = np.where(higher[:, None], shadow_box(sheet, corner[:, None], side), shadow_box(sheet, side, corner[:, None]))
    sizes = np.linalg.norm(side[:, 0] - corner, axis=1) * np.linalg.norm(side[:, 1] - corner, axis=1)
    apart = np.linalg.norm(normals, axis=1) > FLAT * sizes
    return sheet.lines(normals[apart], corner[apart], shared(boxes, within)[apart])


def pair(sheet: Sheet, light: Loop, one: Loop, other: Loop, box: np.ndarray) -> Iterator[np.ndarray]:
    """Where the shadows of two blockers on the light begin to overlap, and where the crossing of their edges reaches its edge."""
    if empty(box):
        return
    if coplanar(one, other):
        yield passing(sheet, crossings(one, other), edges(light), box)
        return
    for a, b in permutations((one, other)):
        yield passing(sheet, a, edges(b), box)
    yield triple(sheet, edges(light), edges(one), edges(other), box)


def coplanar(one: Loop, other: Loop) -> bool:
    normal = geometry.unit(geometry.vector_area(one))
    return bool(np.abs((other - one[0]) @ normal).max() <= FLAT * max(np.abs(one).max(), np.abs(other).max()))


def crossings(one: Loop, other: Loop) -> np.ndarray:
    """The points (m, 3) where the edges of coplanar polygons cross."""
    normal, found = geometry.unit(geometry.vector_area(one)), []
    for a, b in edges(one):
        for c, d in edges(other):
            first, last = np.cross(b - a, c - a) @ normal, np.cross(b - a, d - a) @ normal
            if first * last < 0 and (np.cross(d - c, a - c) @ normal) * (np.cross(d - c, b - c) @ normal) < 0:
                found.append(c + (d - c) * first / (first - last))
    return np.array(found).reshape(-1, 3)


def triple(sheet: Sheet, a: np.ndarray, b: np.ndarray, c: np.ndarray, box: np.ndarray) -> np.ndarray:
    """The conics from which three edges, one of each set (k, 2, 3), are seen to cross in one point: the planes through the
    receiver and the edges share a line."""
    i, j, k = (index.ravel() for index in np.indices((len(a), len(b), len(c))))
    a, b, c = a[i], b[j], c[k]
    boxes = shared(box, shared(highest_first(sheet, a, b), shared(highest_first(sheet, a, c), highest_first(sheet, b, c))))
    a, b, c, boxes = (rows[[not empty(own) for own in boxes]] for rows in (a, b, c, boxes))

    def sides(side: np.ndarray, x: np.ndarray) -> np.ndarray:
        return np.cross(side[:, None, 0] - x, side[:, None, 1] - x)

    def alignment(x: np.ndarray) -> np.ndarray:
        return np.einsum("ijk,ijk->ij", sides(a, x), np.cross(sides(b, x), sides(c, x)))

    def scale(x: np.ndarray) -> np.ndarray:
        return np.prod([np.linalg.norm(sides(side, x), axis=-1) for side in (a, b, c)], axis=0).max(axis=1)

    x = sheet.center + sheet.u * np.array([[0], [0.5], [-0.5], [0.37]]) + sheet.v * np.array([[0], [0.3], [0.5], [-0.41]])
    generic = np.abs(alignment(x)).max(axis=1, initial=0) > FLAT * scale(x)
    return sheet.conics(alignment, boxes)[generic] if len(a) else np.zeros((0, 10))


def highest_first(sheet: Sheet, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Boxes (m, 4) around the shadow of the lower of two edges (m, 2, 3) in the light of the higher."""
    higher = sheet.height(one).min(axis=1) > sheet.height(other).max(axis=1)
    return np.where(higher[:, None], shadow_box(sheet, one, other), shadow_box(sheet, other, one))


def crowds(sheet: Sheet, light: Loop) -> Iterator[np.ndarray]:
    """Lines around what of the light is nearer to the film than an element is wide."""
    for corner in light:
        yield from squares(sheet, corner)
    for start, end in edges(light):
        yield from strips(sheet, start, end)


def touching(sheet: Sheet, loop: Loop) -> np.ndarray:
    """Squares around the corners of a blocker that touch the film."""
    low = loop[sheet.height(loop) <= FLAT * np.abs(loop).max()]
    return np.concatenate([np.zeros((0, 10)), *(rows for corner in low for rows in squares(sheet, corner))])


def radii(sheet: Sheet, height: float) -> np.ndarray:
    """Distances from what is so high to the lines around it, from about the height to the width of an element."""
    least = max(height, LEAST * sheet.cell)
    return least * SPREAD ** np.arange(max(0, np.ceil(np.log(sheet.cell / least) / np.log(SPREAD))))


def squares(sheet: Sheet, corner: np.ndarray) -> Iterator[np.ndarray]:
    """Lines along u and v on either side of a corner, each as long as the next larger square around it."""
    p, q = sheet.places(corner)
    for radius in radii(sheet, float(sheet.height(corner))):
        a, b = radius / np.linalg.norm(sheet.u), radius / np.linalg.norm(sheet.v)
        box = [p - SPREAD * a, p + SPREAD * a, q - SPREAD * b, q + SPREAD * b]
        yield np.array([[-(p + side * a), 1, 0, 0, 0, 0, *box] for side in (-1, 1)])
        yield np.array([[-(q + side * b), 0, 1, 0, 0, 0, *box] for side in (-1, 1)])


def strips(sheet: Sheet, start: np.ndarray, end: np.ndarray) -> Iterator[np.ndarray]:
    """Lines along an edge on either side of it, and the edge's own."""
    low, high = sorted(sheet.height(np.array([start, end])))
    across = np.cross(sheet.normal, end - start)
    if high > sheet.cell or high <= LEAST * sheet.cell or not across.any():
        return
    across = geometry.unit(across)
    offsets = radii(sheet, float(low))
    places = sheet.places(np.array([start, end]))
    lowest, highest = places.min(axis=0), places.max(axis=0)
    for offset in [0.0, *offsets, *-offsets]:
        margin = SPREAD * (abs(offset) or low) / min(np.linalg.norm(sheet.u), np.linalg.norm(sheet.v))
        box = np.array([lowest[0] - margin, highest[0] + margin, lowest[1] - margin, highest[1] + margin])
        yield sheet.lines(across[None], (start + offset * across)[None], box[None])
