"""What a command ends with, and how it complains of its arguments."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

DONE = 0
FAILED = 1
USAGE = 2
INCOMPLETE = 3


class UsageError(ValueError):
    """A bad argument: says which and what would be right."""


def unknown(what: str, name: str, known: Iterable[str]) -> UsageError:
    """The complaint about a name that nobody knows, with those that come closest, or else all."""
    known = list(known)
    close = difflib.get_close_matches(name, known, n=3)
    advice = f"did you mean {' or '.join(close)}?" if close else f"there are {', '.join(known)}"
    return UsageError(f"there is no {what} {name!a}; {advice}")
