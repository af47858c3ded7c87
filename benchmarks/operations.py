"""Arithmetic in the inner loop of a compiled kernel, counted in its assembly (x86 with AVX2 or AVX-512)."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass

LANES = {"x": 4, "y": 8, "z": 16}  # float32 in a register of 128, 256, 512 bits
FUSED = re.compile(r"vfn?m(add|sub)\d+ps")
FLOATING = re.compile(r"v(add|sub|mul|div|max|min|sqrt)ps|vr(cp|sqrt)(14)?ps")
WHOLE = re.compile(r"vp(add|sub|mull|xor|or|and|srl|sll|sra)[a-z]*")
CONVERTED = "vcvtdq2ps"
DRAWS = 4  # coordinates of a sample, each converted from a whole number once
INSTRUCTION = re.compile(r"\t(v\w+)\s")
LABEL = re.compile(r"^(\.L\w+):")
JUMP = re.compile(r"\tj\w+\s+(\.L\w+)")
BY_HAND = 24
"""Floating-point operations of one unoccluded `mc-area` sample under a flat light parallel to the film, read off the
source, a multiply-add as two: 4 for the point of the element, 8 for that of the light, 2 for the vector between (its z is
known), 4 for its square, 1 for the square of that, 1 division, 1 for the pivot, 3 to add up the value and its square."""


@dataclass(frozen=True)
class Operations:
    """Of one sample: floating-point operations (a multiply-add is two), those of whole numbers, conversions, and vector
    instructions of any kind; and how many multiply-adds the loop holds as packed instructions."""

    floating: float
    whole: float
    conversions: float
    instructions: float
    packed_multiply_adds: int
    lanes: int


def count(assembly: str) -> Operations | None:
    """What a kernel's vector loop does for each sample; None where there is no loop in vector registers that converts draws."""
    loop = max(loops(assembly), key=lambda body: sum(bool(FUSED.match(name)) for name, _ in body), default=[])
    converting = [width for name, width in loop if name == CONVERTED]
    if not converting:
        return None
    names, lanes = Counter(name for name, _ in loop), LANES[converting[0]]
    samples = len(converting) * lanes / DRAWS
    fused = _matching(names, FUSED)
    per_sample = [number * lanes / samples for number in (2 * fused + _matching(names, FLOATING), _matching(names, WHOLE))]
    return Operations(*per_sample, DRAWS, len(loop) / samples, fused, lanes)


def packed_multiply_adds(assembly: str) -> int:
    """Multiply-adds on whole vector registers anywhere in a kernel."""
    return sum(bool(FUSED.match(name)) for body in loops(assembly) for name, _ in body)


def loops(assembly: str) -> list[list[tuple[str, str]]]:
    """The vector instructions, each with the letter of its widest register, of every innermost loop: from a label to the jump
    back to it."""
    found, label, body = [], "", []
    for line in assembly.splitlines():
        if start := LABEL.match(line):
            label, body = start[1], []
        elif (jump := JUMP.match(line)) and jump[1] == label:
            found.append(body)
            label, body = "", []
        elif instruction := INSTRUCTION.match(line):
            body.append((instruction[1], max(re.findall(r"%([xyz])mm", line), default="x")))
    return found


def _matching(names: Counter[str], pattern: re.Pattern[str]) -> int:
    return sum(number for name, number in names.items() if pattern.fullmatch(name))
