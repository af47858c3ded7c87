"""How the page says numbers and foreign text."""

from __future__ import annotations

import math
import re
import unicodedata
from datetime import datetime

INVISIBLE = ("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp")  # categories: control, format, surrogate, unassigned, separators


def printable(text: str) -> str:
    """`text` with everything that steers a terminal, a browser or a line's direction spelt out as an escape."""
    return "".join(_spelt(letter) if unicodedata.category(letter) in INVISIBLE else letter for letter in text)


def _spelt(letter: str) -> str:
    return " " if letter in "\t\r\n" else letter.encode("unicode_escape").decode()


def number(value: float, digits: int = 3) -> str:
    """A number to `digits` significant digits, with a true minus and powers of ten where zeros would pile up."""
    if not math.isfinite(value):
        return "\N{EM DASH}" if math.isnan(value) else ("\N{MINUS SIGN}\N{INFINITY}" if value < 0 else "\N{INFINITY}")
    mantissa, mark, exponent = f"{value:.{digits}g}".partition("e")
    power = f" \N{MULTIPLICATION SIGN} 10{superscript(int(exponent))}" if mark else ""
    return mantissa.replace("-", "\N{MINUS SIGN}") + power


def superscript(value: int) -> str:
    """An integer as superscript letters."""
    return str(value).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def percent(value: float, digits: int = 2) -> str:
    """A fraction as per cent, never in powers of ten: of less than a ten-thousandth of a per cent only that."""
    if not math.isfinite(value):
        return number(value)
    if abs(value) < 1e-6:
        return "0 %" if value == 0 else "< 0.0001 %"
    return f"{_fixed(100 * value, max(0, digits - 1 - _exponent(100 * value)))} %"


def triangles(change: float) -> str:
    """What is to be said of triangles that change an element by up to `change` of the tolerance scale."""
    if not math.isfinite(change):
        return "what triangles in the place of round shapes change is not known"
    return f"triangles in the place of round shapes change an element by at most {percent(change)}"


def interval(low: float, high: float) -> str:
    """An interval of fractions as centre ± half width in per cent, to two digits of the half width and at most four decimals."""
    centre, half = 50 * (low + high), 50 * (high - low)
    if not math.isfinite(centre + half):
        return number(math.nan)
    if half < 5e-5:
        return percent(centre / 100)
    decimals = min(4, max(0, 1 - _exponent(half)))
    return f"{_fixed(centre, decimals)} ± {_fixed(half, decimals)} %"


def _exponent(value: float) -> int:
    return math.floor(math.log10(abs(value)))


def _fixed(value: float, decimals: int) -> str:
    text = f"{value:.{decimals}f}"
    return text.lstrip("-") if float(text) == 0 else text.replace("-", "\N{MINUS SIGN}")


def seconds(value: float) -> str:
    """A duration [s] in the unit that suits it; nobody knows one that is no number."""
    if math.isnan(value):
        return "unknown"
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if value >= size:
            return f"{value / size:.0f} {unit}" if value >= 100 * size else f"{value / size:.2g} {unit}"
    return f"{value / 1e-9:.0f} ns" if value else "0 s"


def count(value: float) -> str:
    """A large count: 64, 4,096, 1.05 M, 4.7 G."""
    for letter, size in (("G", 1e9), ("M", 1e6)):
        if value >= size:
            return f"{value / size:.3g} {letter}"
    return f"{value:,.0f}"


def moment(iso: str) -> str:
    """A moment in ISO 8601 as a date and a time of day."""
    when = datetime.fromisoformat(iso)
    return f"{when.day} {when:%B %Y, %H:%M %Z}"


def unbroken(text: str) -> str:
    """`text` that breaks into lines nowhere between a number and its unit."""
    return re.sub(r"(?<=\d) (?=%|[mµn]?s\b|×)", "\N{NO-BREAK SPACE}", text)


def multiple(value: float) -> str:
    """How many times: two digits, of large ones three; 0.83, 4.2, 87, 1,340."""
    return f"{float(f'{value:.3g}'):,.0f}" if value >= 99.5 else number(value, 2)


def amount(value: float, unit: str) -> str:
    """A value with its unit: 0.37 m, 10⁻⁹ m, 45°."""
    text = number(float(value), 2).removeprefix("1 × ") if not 1e-3 <= value < 1e4 else f"{value:.4g}"
    return f"{text}{' ' if unit and unit != '°' else ''}{unit}"


def short(value: float) -> str:
    """A magnitude in as few letters as tell it: 2e-16, 0.3, 40."""
    if not math.isfinite(value):
        return "∞"
    if 0.095 <= value < 9.5:
        return f"{value:.1f}".removesuffix(".0")
    if 9.5 <= value < 999.5:
        return f"{value:.0f}"
    mantissa, _, power = f"{value:.0e}".partition("e")
    return f"{mantissa}e{int(power)}".replace("-", "\N{MINUS SIGN}")


def signed(value: float) -> str:
    """An error: in per cent where that is short."""
    sign = "+" if value > 0 else ""
    return f"{sign}{percent(value)}" if 1e-4 <= abs(value) < 100 else f"{sign}{number(float(value), 2)}"
