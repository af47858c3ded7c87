"""How the page says numbers, intervals, times and foreign text."""

from __future__ import annotations

import math

import pytest

from lightproof.reporting import wording


@pytest.mark.parametrize(("value", "said"), [
    (0.0, "0"), (1.5, "1.5"), (-0.25, "−0.25"), (3e-16, "3 × 10⁻¹⁶"), (1.234567e9, "1.23 × 10⁹"),
    (math.inf, "∞"), (-math.inf, "−∞"), (math.nan, "—"),
])
def test_number(value, said):
    assert wording.number(value) == said


@pytest.mark.parametrize(("value", "said"), [(0.01, "1.0 %"), (1.234, "123 %"), (3.3e-5, "0.0033 %"), (1e-9, "< 0.0001 %"),
                                             (0.0, "0 %"), (math.nan, "—")])
def test_percent(value, said):
    """Fractions; two digits, and never a power of ten."""
    assert wording.percent(value) == said


@pytest.mark.parametrize(("change", "said"), [
    (2.4e-5, "triangles in the place of round shapes change an element by at most 0.0024 %"),
    (0.0, "triangles in the place of round shapes change an element by at most 0 %"),
    (3.0, "triangles in the place of round shapes change an element by at most 300 %"),
    (math.inf, "what triangles in the place of round shapes change is not known"),
])
def test_triangles(change, said):
    """Fractions of the tolerance scale."""
    assert wording.triangles(change) == said


@pytest.mark.parametrize(("low", "high", "said"), [
    (-0.0002, 0.0004, "0.010 ± 0.030 %"),  # two digits of the half width
    (1.0300, 1.0310, "103.050 ± 0.050 %"),
    (-0.25, 0.05, "−10 ± 15 %"),
    (3.9e-4, 3.9e-4, "0.039 %"),  # no width worth a digit
    (-1e-17, 1e-17, "0 %"),
    (2e-9, 2e-9, "< 0.0001 %"),
    (-2e-9, -2e-9, "< 0.0001 %"),
    (math.nan, math.nan, "—"),
])
def test_interval(low, high, said):
    """Ends as fractions; said in per cent."""
    assert wording.interval(low, high) == said


@pytest.mark.parametrize(("value", "said"), [
    (2.3, "2.3 s"), (140.2, "140 s"), (0.0281, "28 ms"), (0.312, "312 ms"), (26e-6, "26 µs"), (4e-9, "4 ns"), (0.0, "0 s"),
])
def test_seconds(value, said):
    assert wording.seconds(value) == said


@pytest.mark.parametrize(("value", "said"), [(64, "64"), (4096, "4,096"), (1048576, "1.05 M"), (4.7e9, "4.7 G")])
def test_count(value, said):
    assert wording.count(value) == said


def test_moment():
    assert wording.moment("2026-01-02T03:04:05+00:00") == "2 January 2026, 03:04 UTC"


def test_printable_spells_out_what_steers_and_keeps_what_is_read():
    """An escape sequence, a direction mark, a lone surrogate and a line break; umlauts, Greek and signs stay."""
    assert wording.printable("\x1b[1m\u202ea\udc80\nb") == "\\x1b[1m\\u202ea\\udc80 b"
    assert wording.printable("Größe π ± 2 m²") == "Größe π ± 2 m²"
