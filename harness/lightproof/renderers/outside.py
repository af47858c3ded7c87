"""A renderer in any language: an executable that its manifest describes, asked by the protocol of examples/README.md."""

from __future__ import annotations

import json
import tempfile
import uuid
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar

from lightproof.checked import plain
from lightproof.method import Method, Rendering
from lightproof.renderers import manifest, protocol
from lightproof.renderers.program import Program
from lightproof.renderers.protocol import AnswerError, Declined, FilmFile, Job
from lightproof.scene import Scene

FILM, JOB = "film.exr", "job.json"


class Outside(Method):
    """Jobs for a program that stays up, or that is started anew for each. After any fault it is started anew."""

    path: ClassVar[Path]

    @classmethod
    def at(cls, path: Path) -> type[Method]:
        """The method that the manifest at `path` describes."""
        return type(cls.__name__, (cls,), {"path": path})

    def open(self) -> None:
        """Raises SceneError on a bad manifest, Unavailable where the program is not there."""
        self.manifest = manifest.read(self.path)
        self.deterministic = self.manifest.deterministic
        self.samples_lights = self.manifest.samples_lights
        self.precision = self.manifest.precision
        self._folder = self.path.parent
        self._command = manifest.found(self.manifest.command, self._folder)
        self._version = self._told(manifest.found(self.manifest.version, self._folder))
        self._program: Program | None = None

    def version(self) -> str:
        return self._version

    def settings(self) -> Mapping[str, Any]:
        return {"command": list(self.manifest.command), "mode": self.manifest.mode}

    def unsupported(self, scene: Scene) -> str | None:
        return self.manifest.supports.lacks(scene)

    def prepare(self, scene: Scene) -> dict[str, float]:
        """The scene goes with each job; a program that stays up is started here, which counts as set-up."""
        self._scene = scene
        if self.manifest.mode == "lasting":
            self._up()
        return {}

    def render(self, samples: int, seed: int) -> Rendering:
        """Raises NotImplementedError with the program's reason, AnswerError, FilmError."""
        with tempfile.TemporaryDirectory(prefix="lightproof-") as folder:
            job = self._job(samples, seed, Path(folder))
            try:
                answer = protocol.read_answer(self._ask(job, Path(folder)), job)
            except Exception:
                self._close()
                raise
        if isinstance(answer, Declined):
            raise NotImplementedError(answer.unsupported)
        return answer

    def _job(self, samples: int, seed: int, folder: Path) -> Job:
        scene, (rows, columns) = self._scene, self._scene.film.grid
        table = {"id": scene.id, "case": scene.case, **scene.to_table()}
        film = FilmFile(str(folder / FILM), rows, columns)
        return Job(uuid.uuid4().hex, scene.digest, table, samples, seed, self.threads, film)

    def _ask(self, job: Job, folder: Path) -> bytes:
        text = json.dumps(job.to_table(), allow_nan=False)
        if self.manifest.mode == "lasting":
            return self._up().ask(text.encode())
        file = folder / JOB
        file.write_text(text)
        return self._once([*self._command, str(file)])

    def _up(self) -> Program:
        """The program that stays up, started if it is not."""
        if self._program is None or self._program.ended:
            self._close()
            self._program = Program(self._command, self._folder, listens=True)
        return self._program

    def _once(self, command: list[str]) -> bytes:
        """The only line that a command writes."""
        program = Program(command, self._folder, listens=False)
        try:
            line = program.line()
            program.end()
            return line
        finally:
            program.close()

    def _told(self, command: list[str]) -> str:
        """The version that a command prints. Raises AnswerError where it prints none."""
        try:
            version = plain(self._once(command).decode(errors="replace"))
        except AnswerError as error:
            raise AnswerError(f"{' '.join(self.manifest.version)} is to print a version in one line, but {error}") from None
        if not version:
            raise AnswerError(f"{' '.join(self.manifest.version)} is to print a version, but it printed an empty line")
        return version

    def _close(self) -> None:
        if self._program:
            self._program.close()
            self._program = None


class Undeclared(Outside):
    """The same program asked to do every scene, whatever its manifest says: does it decline by itself what it cannot do?"""

    def unsupported(self, scene: Scene) -> None:
        """Told by the program."""
