"""Where a recipe's questions go: to the terminal, or into a folder from where somebody elsewhere answers them."""

from __future__ import annotations

import json
import os
import sys
import time
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError, error
from pico.disk import write_whole

from ..session import Session
from ..terminal.output import write

if TYPE_CHECKING:
    from pico.model.trace.question import Answer, Question

FOLDER, ATTENDED = "PICO_QUESTIONS", "PICO_ATTENDED"
"""What names the folder where questions lie and answers come, and what says that somebody sits before it."""
PAUSE = 0.1
"""Seconds between two looks whether an answer came."""


def at_terminal(session: Session) -> bool:
    """Return whether somebody sits at the terminal of this command, and is shown what it says."""
    return sys.stdin is not None and sys.stdin.isatty() and not session.json


@dataclass
class Terminal:
    """Asks who sits at the terminal."""

    session: Session

    def ask(self, question: Question) -> Answer:
        """Ask until the answer is one; raises PicoError where the terminal ends."""
        from pico.model.trace.question import Answer
        from pico.recipes.parameters import answered

        if question.kind == "confirm":
            return Answer(self.session.confirm(question.text, False))
        while True:
            write(sys.stdout, prompt(question), end="")
            try:
                return Answer(answered(question, input()))
            except (EOFError, OSError) as exc:
                raise PicoError(error("declined", f"nothing was answered: {question.text}")) from exc
            except PicoError as exc:
                self.session.report(exc.diagnostics)


@dataclass
class Elsewhere:
    """Asks by a document of what the command says, and a file in a folder; waits for the file of its answer."""

    session: Session
    folder: Path
    asked: int = field(default=0, init=False)

    def ask(self, question: Question) -> Answer:
        """Ask, and wait for as long as it takes; raises PicoError where the question can't be written."""
        from pico.model.trace.question import ASKED, Answer, answer_at, data

        self.asked += 1
        document = data(question, f"q{self.asked}")
        try:
            write_whole(self.folder / ASKED, json.dumps(document).encode())
            self.session.document(document)
            while True:
                with suppress(OSError, ValueError):  # it is not there yet, or not whole
                    found = json.loads(answer_at(self.folder, document["id"]).read_bytes())
                    return Answer(found["value"], found["by"])
                time.sleep(PAUSE)
        finally:
            (self.folder / ASKED).unlink(missing_ok=True)


def prompt(question: Question) -> str:
    """Return the line before which a person answers."""
    from pico.model.trace.question import wanted
    from pico.recipes.terms import said

    usual = f"; without a word {said(question.default)}" if question.default is not None else ""
    return f"{question.text} [{wanted(question)}{usual}] "


def asker(session: Session) -> Terminal | Elsewhere | None:
    """Return by what questions are asked; None where nobody could answer."""
    if at_terminal(session):
        return Terminal(session)
    folder = os.environ.get(FOLDER)
    return Elsewhere(session, Path(folder)) if folder and session.json else None


def attended(session: Session) -> bool:
    """Return whether somebody is there while it runs: at the terminal, or at the page that began it."""
    return at_terminal(session) or (isinstance(asker(session), Elsewhere) and bool(os.environ.get(ATTENDED)))
