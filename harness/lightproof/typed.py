"""What JSON gave, held to the types that a dataclass states: a record may have been edited, or come from a stranger."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from typing import Any

from lightproof.checked import shown

KINDS: dict[str, Callable[[Any], bool]] = {
    "str": lambda value: isinstance(value, str),
    "bool": lambda value: isinstance(value, bool),
    "int": lambda value: type(value) is int and value >= 0,
    "float": lambda value: type(value) in (int, float) and 0 <= value < math.inf,
    "list": lambda value: isinstance(value, list),
    "Mapping[str, str]": lambda value: isinstance(value, dict) and all(map(KINDS["str"], value.values())),
    "Mapping[str, float]": lambda value: isinstance(value, dict) and all(map(KINDS["float"], value.values())),
    "Mapping[str, Any]": lambda value: isinstance(value, dict),
}


def check(record: Any, besides: Sequence[str] = ()) -> Any:
    """A dataclass object, once its fields hold what they say, and numbers 0 or more; but for `besides`. Raises TypeError."""
    kinds = {field.name: field.type for field in fields(record) if field.name not in besides}
    check_keys({name: getattr(record, name) for name in kinds}, kinds)
    return record


def check_keys(table: Mapping[str, Any], kinds: Mapping[str, str]) -> None:
    """Raise TypeError where a key of `table` that is in `kinds` has a value of another kind."""
    for name in table.keys() & kinds.keys():
        if not KINDS[kinds[name]](table[name]):
            raise TypeError(f"{name} is {shown(table[name])}; it must be a {kinds[name]}")
