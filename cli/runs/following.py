"""A recipe beside the coordinator is followed at a terminal: what it asks is answered there, or elsewhere meanwhile."""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Iterator
from queue import Empty, Queue
from threading import Thread
from typing import TYPE_CHECKING, Any

from pico.diagnostics import ExitCode, PicoError

from ..session import Session
from ..terminal.output import write
from .asking import PAUSE, prompt

if TYPE_CHECKING:
    from pico.edge.network.remotes import Remote
    from pico.model.trace.question import Question


class Following:
    """Follows the run of a desk at `path`, with a person at the terminal."""

    def __init__(self, session: Session, remote: Remote, path: str) -> None:
        self.session, self.remote, self.path = session, remote, path
        self._heard: Queue[dict[str, Any] | BaseException] = Queue()
        self._asked: tuple[str, Question] | None = None
        self._typed = b""

    def documents(self) -> Iterator[dict[str, Any]]:
        """Yield what it says, up to how it ended, and have what it asks answered meanwhile. Raises PicoError."""
        from pico.model.trace.question import SCHEMA, question_of

        Thread(target=self._hear, daemon=True).start()
        while True:
            try:
                found = self._heard.get(timeout=PAUSE)
            except Empty:
                if self._asked and (word := self._word()) is not None:
                    self._answer(*self._asked, word)
                continue
            if isinstance(found, BaseException):
                raise found
            if self._asked:
                write(sys.stdout, "")
                self._asked = None
            if found.get("schema") == SCHEMA:
                self._ask(found["id"], question_of(found))
                continue
            yield found
            if "exit" in found and "schema" not in found:
                return

    def _hear(self) -> None:
        from pico.edge.network.asking import lines

        try:
            for document in lines(self.remote, f"{self.path}/events"):
                self._heard.put(document)
        except BaseException as exc:
            self._heard.put(exc)

    def _ask(self, number: str, question: Question) -> None:
        self._asked = number, question
        write(sys.stdout, prompt(question), end="")

    def _answer(self, number: str, question: Question, word: str) -> None:
        from pico.edge.network.asking import ask

        self._asked = None
        try:
            ask(self.remote, "POST", f"{self.path}/answers", {"question": number, "answer": word})
        except PicoError as exc:
            self.session.report(exc.diagnostics)
            if exc.exit_code != ExitCode.STALE:
                self._ask(number, question)

    def _word(self) -> str | None:
        """Return a line that was typed; None where there is none yet, or nobody will type any more."""
        if b"\n" not in self._typed and select.select([sys.stdin], [], [], 0)[0]:
            data = os.read(sys.stdin.fileno(), 1 << 16)
            if not data:
                self._asked = None
            self._typed += data
        if b"\n" not in self._typed:
            return None
        line, _, self._typed = self._typed.partition(b"\n")
        return line.decode(errors="replace")
