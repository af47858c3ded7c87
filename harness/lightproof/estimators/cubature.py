"""Adaptive cubature over the lights' area and the element's extent, with a proven bound of its error; see `refining`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lightproof.estimators import boxes, elements, lamps, shafts, shapes
from lightproof.estimators.blockers import Casters, between, plane_of, standing
from lightproof.estimators.boxes import place
from lightproof.estimators.compiled import strict, strict_kernel
from lightproof.estimators.estimator import Estimator, spread
from lightproof.estimators.heaps import pop, push
from lightproof.estimators.limits import no_caps, no_cylinders, no_glowing_inside, no_reflections, no_skies, no_solid_angle
from lightproof.estimators.refining import DARK, FINEST, SMOOTH, appraise, cost, likely, summed
from lightproof.estimators.shapes import Sphere
from lightproof.estimators.touching import nothing_below
from lightproof.estimators.views import view
from lightproof.method import Rendering
from lightproof.scene import DirectionalLight, PointLight, Scene

MOST = 2**20  # leaves of an element: 0.1 GB


class Leaves(NamedTuple):
    """Boxes by number (m, 9), the bounds of their errors, or what they can hold at most (m,) [W/m2], what they are, which
    coordinate to halve, and the queue."""

    boxes: np.ndarray
    bounds: np.ndarray
    kinds: np.ndarray
    sides: np.ndarray
    heap: np.ndarray


@strict
def keep(leaves, number, count, lights, blockers, starts, cell, room, coarsest):
    """Queues the box of a number unless it is dark; returns the new count of leaves, and the points that it takes."""
    kind, bound, side = appraise(leaves.boxes[number], lights, blockers, starts, cell, room, coarsest)
    leaves.kinds[number], leaves.bounds[number], leaves.sides[number] = kind, bound, side
    return (count, 0) if kind == DARK else (push(leaves.heap, count, leaves.bounds, number), cost(kind, cell))


@strict
def refine(leaves, first, samples, lights, blockers, starts, cell, room):
    """Takes the worst box, by a finer rule or in halves, until the leaves take so many points or there is no room for more;
    returns the count of leaves and their points."""
    count, points, used = 0, 0, len(first)
    for number in range(used):
        leaves.boxes[number] = first[number]
        count, more = keep(leaves, number, count, lights, blockers, starts, cell, room, SMOOTH)
        points += more
    while count > 0 and points < samples and used < len(leaves.boxes) and leaves.bounds[leaves.heap[0]] > 0:
        worst = leaves.heap[0]
        kind = leaves.kinds[worst]
        count = pop(leaves.heap, count, leaves.bounds)
        points -= cost(kind, cell)
        if SMOOTH <= kind < FINEST:
            count, more = keep(leaves, worst, count, lights, blockers, starts, cell, room, kind + 1)
            points += more
            continue
        halve(leaves.boxes[worst], leaves.boxes[used], 2 * leaves.sides[worst])
        for number in (worst, used):
            count, more = keep(leaves, number, count, lights, blockers, starts, cell, room, max(kind, SMOOTH))
            points += more
        used += 1
    return count, points


@strict
def halve(box, other, at):
    """Leaves the lower half of a coordinate's interval to the box, and the upper to the other."""
    other[:] = box
    box[at + 1] = other[at] = (box[at] + box[at + 1]) / 2


@strict
def gathered(leaves, count, lights, blockers, starts, cell, room):
    """Irradiance, and the bound of its error [W/m2]: undecided boxes may hold nothing, or all that they can. What a million
    additions round off is added last."""
    value, rest, error, held, most = 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(count):
        number = leaves.heap[k]
        box, bound = leaves.boxes[number], leaves.bounds[number]
        if leaves.kinds[number] >= SMOOTH:
            one, lost = summed(box, leaves.kinds[number], lights[int(box[8])], cell)
            (value, off), error = added(value, one), error + bound + lost
            rest += off
        else:
            held, most = held + min(likely(box, lights, blockers, starts, cell, room), bound), most + bound
    return value + rest + held, error + max(held, most - held)


@strict
def added(a, b):
    """a + b rounded, and what that is less than the sum (Knuth 1969, 4.2.2)."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


@strict_kernel
def estimate(lights, blockers, starts, first, receivers, samples, out):
    """Irradiance, the bound of its error [W/m2] and points taken of each of `receivers` (n, 15), into `out` (n, 3). `first`
    (k, 9) are the boxes to start from; the blockers of light k are the rows from starts[k] to starts[k + 1]."""
    size = min(samples, MOST) + len(first)
    leaves = Leaves(np.empty((size, 9)), np.empty(size), np.empty(size, np.int64), np.empty(size, np.int64),
                    np.empty(size, np.int64))
    room, near, walls = np.empty((4, 4, 3)), np.empty_like(lights), np.empty_like(blockers)
    for e in range(len(receivers)):
        row = receivers[e]
        origin, cell = (row[0], row[1], row[2]), (row[12], row[13], row[14])
        frame = (row[3], row[4], row[5]), (row[6], row[7], row[8]), (row[9], row[10], row[11])
        place(lights, boxes.POINTS, boxes.VECTORS, origin, frame, near)
        place(blockers, shafts.POINTS, shafts.VECTORS, origin, frame, walls)
        count, points = refine(leaves, first, samples, near, walls, starts, cell, room)
        out[e, 0], out[e, 1] = gathered(leaves, count, near, walls, starts, cell, room)
        out[e, 2] = points


def no_balls(scene: Scene) -> str | None:
    """Whether a light's points are not those of flat shapes."""
    balls = [glow.owner for glow in lamps.glowing(scene) if isinstance(glow.shape, Sphere)]
    bulbs = [light.id for light in scene.lights if isinstance(light, PointLight | DirectionalLight)]
    found = [*balls, *bulbs]
    return f"it integrates over flat lights, and '{found[0]}' is none; analytic and mc-area can" if found else None


class Cubature(Estimator):
    """`samples` are the points of an element's rules; the film comes with its bound."""

    deterministic = True
    limits = (no_cylinders, no_caps, no_solid_angle, no_reflections, no_skies, no_glowing_inside, no_balls, nothing_below)

    def unsupported(self, scene: Scene) -> str | None:
        return super().unsupported(scene) or self.unseen(scene)

    def unseen(self, scene: Scene) -> str | None:
        seen = view(scene)
        flat = seen is not None and seen.slopes is None
        return None if flat else "its film needs rays or a perspective's elements, which it does not integrate over; path can"

    def build(self, scene: Scene) -> None:
        self.view = view(scene)
        glowing = lamps.glowing(scene)
        casters = Casters.of(standing(scene))
        before = [[piece for piece in between(casters, glow.owner, plane_of(glow.shape), self.view.plane).pieces
                   if shapes.area(piece) > 0] for glow in glowing]
        far = np.abs(np.array([*(glow.shape.center for glow in glowing), *self.view.receivers[:, elements.CENTER]])).max()
        self.lights = np.array([boxes.row(glow.shape, glow.radiance, far) for glow in glowing]).reshape(-1, boxes.WIDTH)
        self.blockers = np.array([shafts.row(piece) for pieces in before for piece in pieces]).reshape(-1, shafts.WIDTH)
        self.starts = np.cumsum([0, *map(len, before)])
        self.first = np.array([box for k, glow in enumerate(glowing) for box in boxes.whole(glow.shape, k)]).reshape(-1, 9)

    def warm_up(self) -> None:
        self.render(1, seed=0)

    def render(self, samples: int, seed: int) -> Rendering:
        value, bound, points = spread(self.add(samples), self.size, 1, 3, self.threads).T
        factor = self.view.factor
        return Rendering(factor * value, max(1, round(points.mean())), bound=factor * bound)

    def add(self, samples: int):
        """What fills the columns of some elements."""

        def fill(first: int, last: int, span: tuple[int, int], out: np.ndarray) -> None:
            estimate(self.lights, self.blockers, self.starts, self.first, self.view.receivers[first:last], samples, out)

        return fill
