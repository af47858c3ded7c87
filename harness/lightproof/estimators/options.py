"""The options of an in-house method, as its name gives them: mc-area/sobol-float64."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from lightproof.estimators.jitter import jitter
from lightproof.estimators.lattice import Lattice
from lightproof.estimators.points import Random
from lightproof.estimators.sobol import sobol

Choices = Mapping[str, Mapping[str, Any]]

SAMPLING: Choices = {  # kind -> name -> what it stands for; the first of a kind is the default
    "points": {"independent": Random, "jitter": jitter, "lattice": Lattice, "sobol": sobol},
    "precision": {"float32": np.float32, "float64": np.float64},
}


def chosen(name: str, choices: Choices) -> dict[str, str]:
    """Kind -> the option of that kind that the method's name ends in. Raises ValueError on an option that is not known, and
    on two of a kind."""
    method, _, rest = name.partition("/")
    known = {option: kind for kind, options in choices.items() for option in options}
    found: dict[str, str] = {}
    while rest:
        option = next((option for option in known if f"{rest}-".startswith(f"{option}-")), None)
        if option is None:
            raise ValueError(f"{method} has no option '{rest}'; its options are {', '.join(known)}, joined by '-'")
        if known[option] in found:
            raise ValueError(f"{name}: '{found[known[option]]}' and '{option}' are two options for its {known[option]}")
        found[known[option]] = option
        rest = rest[len(option) + 1:]
    return {kind: found.get(kind, next(iter(options))) for kind, options in choices.items()}
