"""What several convex blockers leave of a convex light, as a flux through part of a plane.

A receiver sees the light less what each blocker hides of it that no later one hides too. What a light and some blockers seem
to share is again one convex loop; so the sum runs over sets of blockers that overlap as they are seen, and every loop is
integrated over its own pieces of the plane, cut along its own sightlines. Blockers that do not overlap cost one loop each.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import combinations

from flint import arb

from lightproof.certify import conics, flux, planes, sightlines
from lightproof.certify.balls import Point, Vector
from lightproof.certify.contour import Contour
from lightproof.certify.planes import Frame, Line, Plane, Region
from lightproof.certify.polygon import Loop, intersection, loop, visible_pieces
from lightproof.certify.sightlines import Convex, Sightline

Cuts = list[tuple[Line, Sightline]]
Stack = tuple[int, ...]  # numbers of blockers


@dataclass(frozen=True)
class Overlaps:
    """A light and blockers over one plane film: all in front of its plane, the blockers in front of the light's."""

    frame: Frame
    normal: Vector  # unit, of the receivers
    light: Convex
    blockers: tuple[Convex, ...]

    @cached_property
    def _between(self) -> list[list[Plane]]:
        """For each blocker the sightlines that have the light in front and the blocker behind."""
        return [[plane for line in sightlines.before(self.light, blocker) for plane in (line.plane, line.plane.turned)
                 if plane.parts(self.light, blocker)] for blocker in self.blockers]

    @cached_property
    def _lines(self) -> Callable[[Stack], Cuts]:
        return cache(lambda stack: list(self._added(stack)))

    def flux(self, region: Region) -> arb:
        """The integral of irradiance per radiance over film positions of a region in which the light is faced."""
        near = tuple(i for i in range(len(self.blockers)) if self._may_hide(i, region))
        x = self._inside(region)
        scale = Contour.of(loop(self.light, x), x).irradiance(x, self.normal) * planes.area(region)
        total = self._seen(region, (), near, scale)
        return arb(0) if total.contains(0) and not total.is_zero() and self._is_dark(region, near) else total

    def _is_dark(self, region: Region, near: Stack) -> bool:
        """Whether nothing of the light is seen from anywhere in a region: exactly none."""
        parts = [region]
        for stack in (stack for count in (1, 2, 3) for stack in combinations(near, count)):
            parts = [part for whole in parts for part in self._cut(whole, stack)]
        places = [self._inside(part) for part in parts]
        return not any(visible_pieces(loop(self.light, x), [loop(self.blockers[i], x) for i in near], x) for x in places)

    def _may_hide(self, i: int, region: Region) -> bool:
        """False where a plane between light and blocker has the region on the light's side."""
        corners = [self.frame.at(*corner) for corner in region]
        return not any(all(plane.height(corner) >= 0 for corner in corners) for plane in self._between[i])

    def _seen(self, region: Region, stack: Stack, later: Stack, scale: arb) -> arb:
        """The flux from what light and stack share, past later blockers; its shape is the same all over the region."""
        x = self._inside(region)
        shared = self._shared(stack, x)
        if not shared:
            return arb(0)
        hidden = []
        for i, blocker in enumerate(later):
            parts = self._cut(region, (*stack, blocker))
            if len(parts) == 1 and intersection(shared, loop(self.blockers[blocker], x), x) == shared:
                return arb(0)
            hidden += [(part, (*stack, blocker), later[i + 1:]) for part in parts]
        contour = Contour.of(shared, x)
        whole = flux.through(self.frame, region, lambda y: contour.irradiance(y, self.normal), scale)
        return whole - sum((self._seen(*where, scale) for where in hidden), arb(0))

    def _inside(self, region: Region) -> Point:
        return self.frame.at(*planes.inside(region))

    def _shared(self, stack: Stack, x: Point) -> Loop:
        shared = loop(self.light, x)
        for i in stack:
            shared = intersection(shared, loop(self.blockers[i], x), x)
        return shared

    def _cut(self, region: Region, stack: Stack) -> list[Region]:
        """The parts of a region in each of which what the light and a stack seem to share has one shape, given that for the
        stack without its last blocker the region is one. Raises CannotCertify."""
        parts = [region]
        for line, sightline in self._lines(stack):
            parts = [part for whole in parts for part in self._halves(whole, line, sightline)]
        conics.check_absent(self.frame, parts, [self.light, *(self.blockers[i] for i in stack)])
        return parts

    def _halves(self, region: Region, line: Line, sightline: Sightline) -> list[Region]:
        chord = planes.chord(region, line)
        return planes.cut(region, [line]) if chord and sightline.parts(*(self.frame.at(*end) for end in chord)) else [region]

    def _added(self, stack: Stack) -> Iterator[tuple[Line, Sightline]]:
        """The sightlines that the last blocker of a stack adds."""
        *others, last = (self.blockers[i] for i in stack)
        found = [*sightlines.before(self.light, last), *(line for other in others for line in sightlines.beside(other, last))]
        for a, b in combinations([self.light, *others], 2):
            found += sightlines.through_meetings((a, b, last))
        return ((line, sightline) for sightline in found if (line := self.frame.line(sightline.plane)))
