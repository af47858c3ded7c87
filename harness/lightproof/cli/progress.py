"""How far a run is: a bar with the time left on a terminal, plain lines in a pipe."""

from __future__ import annotations

from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bar

from lightproof.runner import Progress


class Display:
    """Shows what the runner tells."""

    def __init__(self, console: Console):
        self._console = console
        self._finished = -1
        columns = (BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("{task.fields[left]}: {task.description}"))
        self._bar = Bar(*columns, console=console, disable=not console.is_terminal)
        self._task = self._bar.add_task("", total=None, left="")

    def __enter__(self) -> Display:
        self._bar.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._bar.stop()

    def show(self, progress: Progress) -> None:
        """Take note of where the run stands."""
        name = progress.cell.name if progress.cell else "done"
        left = f"at most {max(0.0, progress.budget - progress.seconds):.0f} s left"
        self._bar.update(self._task, completed=progress.finished, total=progress.cells, description=name, left=left)
        if not self._console.is_terminal and progress.finished != self._finished:
            self._finished = progress.finished
            print(f"[{progress.finished}/{progress.cells}] {left}: {name}", file=self._console.file, flush=True)
