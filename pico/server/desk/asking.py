"""What a command at a desk asks a person, and the answer that it is brought."""

from __future__ import annotations

import json
from typing import Any

from pico.diagnostics import ExitCode, PicoError, error
from pico.disk import writing
from pico.model.trace.question import ASKED, answer_at, question_of
from pico.server.desk.jobs import Job


def asked(job: Job) -> dict[str, Any] | None:
    """Return the question that a command waits with (`pico.question/v1`), None where it does not."""
    if job.ended.is_set():
        return None
    try:
        found: dict[str, Any] = json.loads((job.folder / ASKED).read_bytes())
    except (OSError, ValueError):
        return None
    return found


def answer(job: Job, number: str, word: str, by: str) -> Any:
    """Answer the question of an id, as a person writes it, and return the value that it has; raises PicoError, with
    exit code STALE where it is not asked any more."""
    from pico.recipes.parameters import answered

    document, path = asked(job), answer_at(job.folder, number)
    if path.exists():
        raise _over(f"{_who(path.read_bytes())} has answered it")
    if document is None or document["id"] != number:
        raise _over(f"{job.about.id} does not ask {number}" if document else f"{job.about.id} asks nothing now")
    value = answered(question_of(document), word)
    with writing(path):
        try:
            with path.open("xb") as file:
                file.write(json.dumps({"value": value, "by": by}).encode())
        except FileExistsError as exc:
            raise _over("somebody has answered it at the same time") from exc
    return value


def _who(text: bytes) -> str:
    try:
        return str(json.loads(text)["by"])
    except ValueError:  # it is being written
        return "somebody"


def _over(text: str) -> PicoError:
    return PicoError(error("answered", text, hint="`GET .../desk/runs` tells what is asked"), ExitCode.STALE)
