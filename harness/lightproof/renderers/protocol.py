"""What is said between the harness and a renderer outside: a job, and its answer, each one line of JSON.

examples/README.md is the manual of this protocol. An answer comes from a stranger: it is read strictly, and whatever is
wrong with it is an AnswerError that says what, where and what would be right.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lightproof import checked, films
from lightproof.checked import Checked, SceneError, shown
from lightproof.method import Rendering
from lightproof.renderers import fields

VERSION = 1
LONGEST_ANSWER = 1 << 26  # bytes; a film that needs more goes into a file
IN_FILE = "file"
VALUES = {"type": "array", "items": {"type": "number", "minimum": 0}}


class AnswerError(ValueError):
    """An answer that is none to the job: says what is wrong and what would be right."""


def _scene() -> Any:
    return checked.rule(lambda table: table, {"$ref": "#/$defs/scene"})


def _values() -> Any:
    return checked.rule(lambda value: None if value is None else to_values(value), VALUES, None)


def _film() -> Any:
    def check(value: Any) -> np.ndarray | str:
        return value if isinstance(value, str) and value == IN_FILE else to_values(value)

    return checked.rule(check, {"oneOf": [{"const": IN_FILE}, VALUES]})


def to_values(value: Any) -> np.ndarray:
    """A list of numbers, as (n,); whether they can be light is for the reader of films to say."""
    if not isinstance(value, list):
        raise SceneError("", f"{shown(value)} is not accepted; give a list of numbers, row by row")
    wrong = next((index for index, each in enumerate(value) if type(each) not in (int, float)), None)
    if wrong is not None:
        raise SceneError(f"[{wrong}]", f"{shown(value[wrong])} is not a number")
    try:
        return np.array(value, float)
    except OverflowError:
        raise SceneError("", "an integer is too large; give finite numbers") from None


@dataclass(frozen=True)
class FilmFile(Checked):
    """Where a film may be put as an OpenEXR image of so many rows and columns, channel Y in 32-bit float. The folder is the
    renderer's own: whatever else it leaves there is deleted."""

    path: str = fields.text()
    rows: int = fields.count(1)
    columns: int = fields.count(1)


@dataclass(frozen=True)
class Job(Checked):
    """One film asked for: of `scene`, at `samples` per element, on at most so many `threads`. The same seed gives the same film,
    another seed an independent one. `job` names this job and `digest` its scene; the answer repeats both."""

    TAG = ("protocol", VERSION)

    job: str = fields.text()
    digest: str = fields.text()
    scene: dict[str, Any] = _scene()
    samples: int = fields.count(1)
    seed: int = fields.count(1)
    threads: int = fields.count(1)
    film: FilmFile = fields.nested(FilmFile)


@dataclass(frozen=True)
class Seconds(Checked):
    """What the job took besides rendering [s]: to build the scene, and to compile code for it. All the rest of the time that the
    harness measures counts as rendering."""

    setup: float = checked.number(least=0, default=0.0)
    compile: float = checked.number(least=0, default=0.0)


@dataclass(frozen=True)
class Rendered(Checked):
    """A film: a list of values in the unit of the film's quantity, row by row, or "file" where it is in the job's film file;
    `samples` were really spent per element. Where the renderer knows them: the `variance` of each value [unit squared], that of
    the value itself and not of one sample, and half a step of its output (`quantization`) [unit]."""

    job: str = fields.text()
    digest: str = fields.text()
    film: np.ndarray | str = _film()
    samples: int = fields.count(1, most=2**62)
    variance: np.ndarray | None = _values()
    quantization: np.ndarray | None = _values()
    seconds: Seconds = fields.nested(Seconds, default=Seconds())


@dataclass(frozen=True)
class Declined(Checked):
    """The renderer cannot do this scene; `unsupported` is the reason, in a sentence for the reader of a report."""

    job: str = fields.text()
    digest: str = fields.text()
    unsupported: str = fields.text()


def read_answer(line: bytes, job: Job) -> Rendering | Declined:
    """What a line says to a job. Raises AnswerError, and films.FilmError for a film file."""
    table = _parse(line)
    try:
        answer = (Declined if isinstance(table, dict) and "unsupported" in table else Rendered).from_table(table)
    except SceneError as error:
        raise AnswerError(f"its answer is none of protocol {VERSION}: {error}") from None
    if answer.job != job.job:
        raise AnswerError(f"it answered job {shown(answer.job)} and not {shown(job.job)}; it must answer each job once, in order")
    if answer.digest != job.digest:
        raise AnswerError(f"its answer is of another scene: its digest is {shown(answer.digest)}, the job's {shown(job.digest)}")
    return answer if isinstance(answer, Declined) else _rendering(answer, job)


def _parse(line: bytes) -> Any:
    try:
        return json.loads(line.decode(), parse_constant=_no_constant, object_pairs_hook=_no_repeats)
    except (ValueError, RecursionError) as error:
        raise AnswerError(f"it wrote {shown(line[:40].decode(errors='replace'))} to its standard output, which is no JSON"
                          f" ({error}); only the answer belongs there, the rest on standard error") from None


def _no_constant(name: str) -> None:
    raise ValueError(f"{name} is no JSON number")


def _no_repeats(pairs: Sequence[tuple[str, Any]]) -> dict[str, Any]:
    table = dict(pairs)
    if len(table) < len(pairs):
        raise ValueError("a key is given twice")
    return table


def _rendering(answer: Rendered, job: Job) -> Rendering:
    given = {"film": answer.film, "variance": answer.variance, "quantization": answer.quantization}
    if isinstance(answer.film, str):
        given |= _from_file(job)
    size = job.film.rows * job.film.columns
    for name, values in given.items():
        if values is not None and len(values) != size:
            raise AnswerError(f"its {name} has {len(values)} values; this film has {job.film.rows} rows of {job.film.columns}")
    seconds = {name: value for name, value in answer.seconds.to_table().items() if value}
    quantization = 0.0 if given["quantization"] is None else given["quantization"]
    return Rendering(given["film"], answer.samples, given["variance"], quantization, seconds)


def _from_file(job: Job) -> dict[str, np.ndarray]:
    """What the film file holds, under the names of an answer."""
    path = Path(job.film.path)
    if not path.is_file():
        raise AnswerError(f'its film is "{IN_FILE}", but it wrote no {path.name} at the path that the job names')
    grid, channels, header = films.read(path)
    if header.get("digest", job.digest) != job.digest:
        raise AnswerError(f"{path.name} is the film of another scene (digest {shown(header['digest'])})")
    if grid != (job.film.rows, job.film.columns):
        raise AnswerError(f"{path.name} has {grid} rows and columns; this film has {(job.film.rows, job.film.columns)}")
    return {"film": channels["Y"], **{name: channels[name] for name in ("variance", "quantization") if name in channels}}
