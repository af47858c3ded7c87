"""Quantities of ISO 80000-7 with their symbols and SI units."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """A radiometric or geometric quantity."""

    name: str
    symbol: str
    unit: str


QUANTITIES = {
    quantity.name: quantity
    for quantity in (
        Quantity("flux", "\N{GREEK CAPITAL LETTER PHI}", "W"),
        Quantity("intensity", "I", "W/sr"),
        Quantity("irradiance", "E", "W/m\N{SUPERSCRIPT TWO}"),
        Quantity("exitance", "M", "W/m\N{SUPERSCRIPT TWO}"),
        Quantity("radiance", "L", "W/(m\N{SUPERSCRIPT TWO} sr)"),
        Quantity("solid_angle", "\N{GREEK CAPITAL LETTER OMEGA}", "sr"),
    )
}
