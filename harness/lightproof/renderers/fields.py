"""Fields of what is exchanged with outside renderers, beside those of scenes in `checked`."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable
from typing import Any

from lightproof import checked
from lightproof.checked import Checked, SceneError, rule, shown

TEXT = {"type": "string", "minLength": 1}


def def_name(cls: type) -> str:
    """The name of a class among the definitions of a schema: film-file for FilmFile."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "-", cls.__name__).lower()


def nested(cls: type[Checked], default: Any = dataclasses.MISSING) -> Any:
    """A field for an object of a Checked class, or the table of one."""
    name = {"$ref": f"#/$defs/{def_name(cls)}"}
    return rule(lambda value: value if isinstance(value, cls) else cls.from_table(value), name, default)


def several(value: Any, check: Callable[[Any], Any], least: int = 0) -> tuple[Any, ...]:
    """A list of at least `least` values, `check` applied to each."""
    if not isinstance(value, list | tuple) or len(value) < least:
        raise SceneError("", f"{shown(value)} is not accepted; give a list{f' of at least {least}' if least else ''}")
    return tuple(checked.indexed(check, value))


def choices(*accepted: str) -> Any:
    """A field for a list of some of a few values, by default all of them."""
    each = {"type": "array", "items": {"enum": list(accepted)}}
    return rule(lambda value: several(value, lambda item: checked.to_choice(item, accepted)), each, accepted)


def text() -> Any:
    """A field for a line of text."""
    return rule(checked.to_text, TEXT)


def count(least: int, most: int = 2**31 - 1) -> Any:
    """A field for a whole number."""
    return rule(lambda value: checked.to_count(value, least, most), {"type": "integer", "minimum": least, "maximum": most})


def flag(default: bool) -> Any:
    """A field that is true or false."""

    def check(value: Any) -> bool:
        if not isinstance(value, bool):
            raise SceneError("", f"{shown(value)} is not accepted; give true or false")
        return value

    return rule(check, {"type": "boolean"}, default)
