"""Second derivation for sphere-blocker: the area form, row by row of the light, elements cut along the shadow's edges.

For a level floor and light whose sides run along x and y. A row of the light loses the interval in which the floor's point sees
the ball, a quadratic; over the rest h^2 / r^4 is elementary. Along a line of the floor the picture changes where a plane
through a side of the light touches the ball (a straight line) and where a cone from a corner does (a conic). Gauss rules, with
a cosine that takes the square roots at both ends away, do the light's rows between the events of a row, the element's lines
between those of a line, and the element between those of its lines; binary64. Points: row by row, as in round-shadows.py.
Prints the base case as JSON.
"""

import json
import tomllib
from itertools import pairwise, product
from pathlib import Path
from runpy import run_path

import numpy as np


def rule(count):
    """Nodes and weights on [0, 1], stretched to nothing at both ends."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (1 - np.cos(np.pi * (1 + nodes) / 2)) / 2, weights * np.pi / 4 * np.sin(np.pi * (1 + nodes) / 2)


ROWS, LINE, ELEMENT = rule(28), rule(24), rule(28)


def values(scene, elements):
    """Irradiance [W/m2] of the film's elements; `scene` is the table of a scene file."""
    film, (lamp,), (surface,) = scene["film"], scene["light"], scene["surface"]
    if film["kind"] == "points":
        return run_path(str(Path(__file__).with_name("round-shadows.py")))["values"](scene, elements)
    assert film["u"][1:] == [0, 0] and film["v"][::2] == [0, 0] and lamp["shape"]["type"] == "polygon"
    corners = np.array(lamp["shape"]["vertices"])
    assert len(corners) == 4 and len(np.unique(corners[:, 0])) == len(np.unique(corners[:, 1])) == 2
    height = corners[0, 2] - film["origin"][2]
    lows, highs = corners[:, :2].min(0) - film["origin"][:2], corners[:, :2].max(0) - film["origin"][:2]
    ball = np.array(surface["shape"]["center"]) - film["origin"]
    picture = (lows, highs, height), (ball, surface["shape"]["radius"])
    columns, rows = film["resolution"]
    means = []
    for element in elements:
        row, column = divmod(element, columns)
        x = [film["u"][0] * (column + i) / columns for i in (0, 1)]
        y = [film["v"][1] * (row + i) / rows for i in (0, 1)]
        means.append(lamp["radiance"] * flux(x, y, *picture) / ((x[1] - x[0]) * (y[1] - y[0])))
    return means


def flux(x, y, light, ball):
    """The integral of irradiance per radiance over an element."""
    corners = product(*zip(*light[:2], strict=True), [light[2]])
    cones = [cone(np.array(corner), *ball) for corner in corners]
    stops = lines(1, light, *ball) + [t for form in cones for t in extent(form)]
    stops += [t for form in cones for side in (*x, *lines(0, light, *ball)) for t in roots(form, 0, side)]
    total = 0.0
    for a, b in pairwise(inside(stops, y)):
        for node, share in zip(*ELEMENT, strict=True):
            level = a + (b - a) * node
            ends = lines(0, light, *ball) + [s for form in cones for s in roots(form, 1, level)]
            for c, d in pairwise(inside(ends, x)):
                along = c + (d - c) * LINE[0]
                total += (b - a) * share * (d - c) * float(LINE[1] @ irradiance(along, level, light, ball))
    return total


def inside(stops, span):
    """The stops within a span, in order, between its ends."""
    return [span[0], *sorted(stop for stop in stops if span[0] < stop < span[1]), span[1]]


def lines(axis, light, ball, radius):
    """Where planes through the light's two sides across an axis that touch the ball meet the floor, along that axis."""
    found = []
    for start in (light[0][axis], light[1][axis]):
        across, up = ball[axis] - start, ball[2] - light[2]
        distance, angle = np.hypot(across, up), np.arctan2(across, -up)
        for sign in (-1, 1):
            slope = angle + sign * np.arcsin(radius / distance)
            if abs(slope) < np.pi / 2:
                found.append(start + light[2] * np.tan(slope))
    return found


def cone(apex, ball, radius):
    """The form (3, 3) in (x, y, 1) of the points on the floor from which the line to an apex touches the ball."""
    axis = ball - apex
    form = np.outer(axis, axis) - (axis @ axis - radius**2) * np.eye(3)
    floor = np.array([[1, 0, -apex[0]], [0, 1, -apex[1]], [0, 0, -apex[2]]])
    return floor.T @ form @ floor


def roots(form, axis, level):
    """The other coordinate of a conic's points with a coordinate (0: x, 1: y) at a level."""
    i = 1 - axis
    a, b, c = form[i, i], form[i, axis] * level + form[i, 2], form[axis, axis] * level**2 + 2 * form[axis, 2] * level + form[2, 2]
    square = b * b - a * c
    return [(-b + sign * np.sqrt(square)) / a for sign in (-1, 1)] if square > 0 else []


def extent(form):
    """The levels of y between which a conic lies."""
    a, b, c = (form[0, i] * form[0, j] - form[0, 0] * form[i, j] for i, j in ((1, 1), (1, 2), (2, 2)))
    square = b * b - a * c
    return [(-b + sign * np.sqrt(square)) / a for sign in (-1, 1)] if square > 0 else []


def irradiance(x, y, light, ball):
    """Irradiance per radiance [sr] at (x, y) on the floor, (n,)."""
    lows, highs, h = light
    whole = (lows[1], highs[1])
    seen = over(x, y, h, np.full((len(x), 1), whole[0]), np.full((len(x), 1), whole[1]), lambda t: (lows[0], highs[0]))
    (p, q, r), radius = ball
    a, b, c = p - x, np.full_like(x, q - y), np.full_like(x, r)
    slack = a * a + b * b + c * c - radius**2

    def chord(t):
        """Where a row of the light meets the ball's outline, within the light."""
        v = t - y
        dot = b[:, None] * v + c[:, None] * h
        m, s = a[:, None], slack[:, None]
        square = np.maximum((m * dot) ** 2 - (m * m - s) * (dot * dot - s * (v * v + h * h)), 0)
        ends = [x[:, None] + (-m * dot + sign * np.sqrt(square)) / (m * m - s) for sign in (1, -1)]
        return tuple(np.clip(end, lows[0], highs[0]) for end in ends)

    first, last = (np.clip(stop + y, *whole) for stop in events(a, b, c, slack, h))
    turns = [turn for side in (lows[0], highs[0]) for turn in sides(a, b, c, slack, h, side - x)]
    between = [np.clip(np.where(np.isnan(turn), first, turn + y), first, last) for turn in turns]
    stops = np.sort(np.stack([first, last, *between], axis=1))
    return seen - over(x, y, h, stops[:, :-1], stops[:, 1:], chord)


def events(a, b, c, slack, h):
    """The rows, from the receiver, between which the ball is seen."""
    return quadratic(a * a + b * b - slack, b * c * h, (a * a + c * c - slack) * h * h)


def sides(a, b, c, slack, h, side):
    """The rows at which the ball's outline crosses a side of the light."""
    dot = a * side + c * h
    return quadratic(b * b - slack, b * dot, dot * dot - slack * (side * side + h * h))


def quadratic(a, b, c):
    """Both roots of a t^2 + 2 b t + c, nan where there are none; the smaller first where a is negative."""
    with np.errstate(invalid="ignore"):
        root = np.sqrt(b * b - a * c)
    return [(-b + sign * root) / a for sign in (1, -1)]


def over(x, y, h, start, end, interval):
    """The integral of h^2 / r^4 over the light's rows from starts to ends (n, k), each over an interval."""
    t = (start[..., None] + (end - start)[..., None] * ROWS[0]).reshape(len(x), -1)
    shares = ((end - start)[..., None] * ROWS[1]).reshape(len(x), -1)
    low, high = interval(t)
    square = (t - y) ** 2 + h * h
    root = np.sqrt(square)
    ends = (side - x[:, None] for side in (low, high))
    strips = [s / (square * (square + s * s)) + np.arctan(s / root) / (square * root) for s in ends]
    return (shares * h * h * (strips[1] - strips[0]) / 2).sum(-1)


if __name__ == "__main__":
    scene = tomllib.loads((Path(__file__).resolve().parents[1] / "scenes/sphere-blocker.toml").read_text(encoding="utf-8"))
    print(json.dumps({"base": dict(enumerate(values(scene, range(len(scene["film"]["positions"])))))}))
