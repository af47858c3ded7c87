"""A method's configurations, named together where the same is true of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from lightproof.renderers.registry import family


def together(said: Mapping[str, str], methods: Iterable[str]) -> list[str]:
    """Method -> what is said of it, or nothing: every one with that in brackets, and as one name those that are all the
    configurations which a method has among `methods`, if the same is said of them."""
    there, alike = Counter(map(family, methods)), Counter((family(method), text) for method, text in said.items())
    names = [_named(method, text, there[family(method)], alike[family(method), text]) for method, text in said.items()]
    return list(dict.fromkeys(names))


def _named(method: str, text: str, there: int, alike: int) -> str:
    whole = 1 < alike == there
    brackets = [*([f"all {there}"] if whole else []), *([text] if text else [])]
    return (family(method) if whole else method) + (f" ({', '.join(brackets)})" if brackets else "")
