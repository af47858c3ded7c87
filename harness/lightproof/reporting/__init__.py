"""Tables, pages and pictures of a run."""

from __future__ import annotations

import functools
import os
from pathlib import Path

from lightproof import store
from lightproof.suite import Suite


def write(run_folder: Path, suite: Suite) -> Path:
    """Judge a run anew and write results.csv, summary.csv, index.html and, where times are known, speed.html and, where cases are
    hard, hard.html into its folder; returns the path of index.html.

    Raises StoreError, FilmError and UnitsError where the folder is no run, or a record is broken, OSError where it cannot be
    written.
    """
    # Here and not above: pandas and altair take a second to import, which the process that renders a picture need not wait for.
    from lightproof.reporting import citations, hard_page, page, speed_page, tables, units
    from lightproof.reporting.evaluation import evaluate
    from lightproof.reporting.pictures import picture

    evaluation = evaluate(store.open(run_folder), suite)
    tables.results(evaluation).to_csv(run_folder / "results.csv", index=False)
    tables.summary(evaluation).to_csv(run_folder / "summary.csv", index=False)
    bibliography = citations.read(suite.root / "references" / "references.bib")
    factors = [*units.read(units.FILE), *units.measure(evaluation)]
    speed = speed_page.views(evaluation)
    if speed:
        html = speed_page.render(speed, evaluation, page.environment(), page.bundle())
        (run_folder / "speed.html").write_text(html, encoding="utf-8")
    hard = hard_page.render(evaluation, page.environment(), page.bundle())
    if hard:
        (run_folder / "hard.html").write_text(hard, encoding="utf-8")
    draw = functools.partial(picture, cache_folder=_picture_cache())
    html = page.render(evaluation, bibliography, draw, factors, speed_page.sentences(speed))
    path = run_folder / "index.html"
    path.write_text(html, encoding="utf-8")
    return path


def _picture_cache() -> Path:
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return home / "lightproof" / "pictures"
