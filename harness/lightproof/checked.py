"""Dataclass fields that check themselves.

A scene may come from a file, from another process or from a notebook; in each case the same rule has to hold and the
same message has to come out. So every field states its rule where it is declared, and `Checked` applies all of them
whenever an object is made. Beside the rule stands what JSON Schema can say of it, for readers in other languages.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, ClassVar, Self

SHORTEST, FARTHEST = 1e-150, 1e150  # m: a binary64 holds the squares of all lengths between
LONGEST_LINE = 400
KEBAB_CASE = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
VECTOR = {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}


class SceneError(ValueError):
    """A scene that breaks the format: says where, what is wrong and what would be right."""

    def __init__(self, where: str, problem: str):
        super().__init__(f"{where}: {problem}" if where else problem)
        self.where = where
        self.problem = problem

    def within(self, outer: str) -> SceneError:
        """The same error, its place named from one level further out."""
        dot = "." if self.where and not self.where.startswith("[") else ""
        return SceneError(f"{outer}{dot}{self.where}", self.problem)


class Checked:
    """Base of frozen dataclasses whose fields carry a rule in their metadata."""

    TAG: ClassVar[tuple[str, Any] | None] = None

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            try:
                value = field.metadata["rule"](getattr(self, field.name))
            except SceneError as error:
                raise error.within(field.name) from None
            object.__setattr__(self, field.name, value)
        self.check()

    def check(self) -> None:
        """Rules that concern several fields at once; raises SceneError."""

    def to_table(self) -> dict[str, Any]:
        """The object as a scene file writes it: the class's own tag (`TAG`, such as ("type", "disk")), then the fields."""
        values = ((field.name, getattr(self, field.name)) for field in dataclasses.fields(self))
        tag = dict([self.TAG]) if self.TAG else {}
        return {**tag, **{name: _plain(value) for name, value in values if value is not None}}

    @classmethod
    def from_table(cls, table: Any) -> Self:
        """The object that a table describes, as `to_table` writes it; its tag may be left out. Raises SceneError, on unknown and
        missing keys too."""
        tag, value = cls.TAG or ("", None)
        fields = dataclasses.fields(cls)
        names = [field.name for field in fields]
        only(table, [tag, *names] if tag else names, [field.name for field in fields if field.default is dataclasses.MISSING])
        if table.get(tag, value) != value:
            raise SceneError(tag, f"{shown(table[tag])} is not accepted; give {value!r}")
        return cls(**{name: table[name] for name in names if name in table})


def by_tag(table: Any, tag: str, classes: Mapping[str, Any]) -> Any:
    """Which of some classes a table describes, by its `tag`, such as "kind". Raises SceneError."""
    if not isinstance(table, dict):
        raise SceneError("", f"{shown(table)} is not a table")
    value = table.get(tag)
    if not isinstance(value, str) or value not in classes:
        raise SceneError(tag, f"{shown(value)} is not accepted; give one of {', '.join(map(repr, classes))}")
    return classes[value]


def _plain(value: Any) -> Any:
    match value:
        case Checked():
            return value.to_table()
        case tuple():
            return [_plain(item) for item in value]
        case _:
            return value


def rule(check: Callable[[Any], Any], schema: dict[str, Any], default: Any = dataclasses.MISSING) -> Any:
    """A dataclass field whose value is replaced by `check(value)`, which raises SceneError on a bad one; `schema` is that of
    what it accepts."""
    return dataclasses.field(default=default, metadata={"rule": check, "schema": schema})


def only(table: Any, known: Sequence[str], required: Iterable[str]) -> None:
    """Raises SceneError where a table is none, lacks a required field, or has one that nobody knows."""
    if not isinstance(table, dict):
        raise SceneError("", f"{shown(table)} is not a table")
    for key in table:
        if key not in known:
            raise SceneError(shown(key)[1:-1], f"is not a field here; the fields are {', '.join(known)}")
    for key in required:
        if key not in table:
            raise SceneError(key, "is missing; it must be given")


def plain(text: str, longest: int = LONGEST_LINE) -> str:
    """What a stranger says, as one line of bearable length that no terminal obeys."""
    line = " ".join("".join(char if char.isprintable() else " " for char in text).split())
    return line if len(line) <= longest else f"{line[:longest]}..."


def shown(value: Any) -> str:
    """A value as an error message shows it: short, and with nothing that a terminal would obey."""
    text = ascii(value)
    return text if len(text) <= 60 else text[:57] + "..."


def to_number(value: Any) -> float:
    """A finite binary64; integers are accepted, booleans and strings are not."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise SceneError("", f"{shown(value)} is not a number; give a finite number")
    try:
        value = float(value)
    except OverflowError:
        value = math.inf
    if not math.isfinite(value):
        raise SceneError("", f"{value} is not finite; give a finite number")
    return value


def number(above: float = -math.inf, least: float = -math.inf, most: float = math.inf, below: float = math.inf,
           default: Any = dataclasses.MISSING) -> Any:
    """A field for one number greater than `above`, from `least` to `most`, less than `below`."""

    def check(value: Any) -> float:
        value = to_number(value)
        if not (above < value < below and least <= value <= most):
            low = f"greater than {above:g}" if above > -math.inf else f"at least {least:g}"
            high = f" and at most {most:g}" if most < math.inf else f" and less than {below:g}" if below < math.inf else ""
            raise SceneError("", f"{value:g} is out of range; it must be {low}{high}")
        return value

    limits = {"exclusiveMinimum": above, "minimum": least, "maximum": most, "exclusiveMaximum": below}
    return rule(check, {"type": "number", **{key: limit for key, limit in limits.items() if math.isfinite(limit)}}, default)


def length() -> Any:
    """A field for a length [m]."""
    return number(least=SHORTEST, most=FARTHEST)


def to_vector(value: Any) -> tuple[float, float, float]:
    """Three numbers from -FARTHEST to FARTHEST."""
    if not isinstance(value, list | tuple) or len(value) != 3:
        raise SceneError("", f"{shown(value)} is not a vector; give three numbers [x, y, z]")
    vector = tuple(to_number(component) for component in value)
    for component in vector:
        if abs(component) > FARTHEST:
            raise SceneError("", f"{component:g} is out of range; give numbers from {-FARTHEST:g} to {FARTHEST:g}")
    return vector


def vector(default: Any = dataclasses.MISSING) -> Any:
    """A field for a position [m]."""
    return rule(to_vector, VECTOR, default)


def to_direction(value: Any) -> tuple[float, float, float]:
    """A vector with a direction; its length means nothing."""
    value = to_vector(value)
    if not any(value):
        raise SceneError("", "[0, 0, 0] has no direction; give a vector that is not zero")
    return value


def direction(default: Any = dataclasses.MISSING) -> Any:
    """A field for a direction of any length except zero."""
    return rule(to_direction, VECTOR, default)


def vectors(least: int, each: Callable[[Any], Any] = to_vector, default: Any = dataclasses.MISSING) -> Any:
    """A field for a list of at least `least` vectors."""

    def check(value: Any) -> tuple[tuple[float, float, float], ...] | None:
        if value is None and default is None:
            return None
        if not isinstance(value, list | tuple) or len(value) < least:
            raise SceneError("", f"{shown(value)} is not a list of at least {least} vectors [x, y, z]")
        return tuple(indexed(each, value))

    return rule(check, {"type": "array", "items": VECTOR, "minItems": least}, default)


def indexed(check: Callable[[Any], Any], values: Any) -> list[Any]:
    """`check` applied to each value; an error names the index."""
    checked = []
    for index, value in enumerate(values):
        try:
            checked.append(check(value))
        except SceneError as error:
            raise error.within(f"[{index}]") from None
    return checked


def to_choice(value: Any, accepted: Sequence[str]) -> str:
    """One of a few values."""
    if not isinstance(value, str) or value not in accepted:
        raise SceneError("", f"{shown(value)} is not accepted; give one of {', '.join(map(repr, accepted))}")
    return value


def choice(*accepted: str, default: Any = dataclasses.MISSING) -> Any:
    """A field that takes one of a few values."""
    return rule(lambda value: to_choice(value, accepted), {"enum": list(accepted)}, default)


def to_text(value: Any) -> str:
    """A line of text, with nothing in it that a terminal would obey."""
    if not isinstance(value, str) or not value.isprintable() or not value:
        raise SceneError("", f"{shown(value)} is not a line of text")
    return value


def to_kebab(value: Any) -> str:
    """An id in kebab-case."""
    if not isinstance(value, str) or not KEBAB_CASE.fullmatch(value):
        raise SceneError("", f"{shown(value)} is not an id; give lower-case words joined by hyphens, such as 'area-lamp'")
    return value


def identifier(default: Any = dataclasses.MISSING) -> Any:
    """A field for an id in kebab-case."""
    return rule(to_kebab, {"type": "string", "pattern": f"^{KEBAB_CASE.pattern}$"}, default)


def to_count(value: Any, least: int = 0, most: int = 2**31 - 1) -> int:
    """A whole number from `least` to `most`."""
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise SceneError("", f"{shown(value)} is not accepted; give a whole number from {least} to {most}")
    return value


def resolution(default: Any = dataclasses.MISSING) -> Any:
    """A field for [columns, rows], each from 1 to 4096."""

    def check(value: Any) -> tuple[int, int]:
        if not isinstance(value, list | tuple) or len(value) != 2:
            raise SceneError("", f"{shown(value)} is not a resolution; give [columns, rows]")
        return tuple(indexed(lambda count: to_count(count, 1, 4096), value))

    count = {"type": "integer", "minimum": 1, "maximum": 4096}
    return rule(check, {"type": "array", "items": count, "minItems": 2, "maxItems": 2}, default)
