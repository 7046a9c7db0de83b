"""Ready-made goals by name: a file each of `pico.bench.ready.goals`, which says what it `TAKES` and makes it of what is
`Asked`; a plug-in brings more by the entry point `pico.goals`, a module of the same kind."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Protocol, cast

from pico.diagnostics import Diagnostic, PicoError
from pico.manifest.checks.goals import goal_errors
from pico.model.observation import Observation
from pico.model.setup import Setup
from pico.planning.asked import Asked, Ready
from pico.planning.nominal import within_reach
from pico.plug_ins.calling import Interface, function, instance
from pico.registered import intact, module, modules

FOLDER = "pico.bench.ready.goals"
GROUP = "pico.goals"


RENAMED = {"centre": "center", "fibre": "fiber"}
"""The words of earlier versions, in recipes and in history, and those of today."""


class GoalFile(Protocol):
    """A file of FOLDER. `TAKES`: the words behind its name, and what it does; `LEAST`: how many words those are. One
    that can be made wherever parts stand says so by `ANYWHERE = True`."""

    TAKES: str
    LEAST: int
    make: Callable[[Asked], Ready]


INTERFACE = Interface(
    GROUP, {"TAKES": instance(str), "LEAST": instance(int), "make": function}, {"make": instance(Ready)}
)


def known() -> tuple[str, ...]:
    """Return the names of all ready-made goals, PICO's own first; imports none of them."""
    return tuple(modules(FOLDER, GROUP))


def current(words: Sequence[str]) -> tuple[str, ...]:
    """Return the words of a ready-made goal with the name that it has today."""
    return (RENAMED.get(words[0], words[0]), *words[1:])


def goal_file(name: str) -> GoalFile:
    """Return the file of a ready-made goal that is known; raises PicoError for a plug-in that is broken."""
    return cast(GoalFile, module(INTERFACE, name))


def takes() -> tuple[dict[str, str], tuple[Diagnostic, ...]]:
    """Return what each ready-made goal takes, and a warning for each plug-in that is broken."""
    found, wrong = intact(INTERFACE)
    return {name: file.TAKES for name, file in found.items()}, wrong


def made_ready(setup: Setup, seen: Observation, words: Sequence[str]) -> Ready:
    """Return a goal of a user's words, that a file is there for; raises PicoError where it can't be made of them."""
    file, asked = goal_file(words[0]), Asked(setup, seen, words[0], tuple(words[1:]))
    if len(asked.words) < file.LEAST:
        raise asked.refused("more must be said", f"{words[0]} {file.TAKES}")
    made = file.make(asked)
    return made.mapped(lambda goal, former: within_reach(setup, seen, goal, former))


def wrong_words(setup: Setup, words: Sequence[str]) -> Iterator[Diagnostic]:
    """Yield what is wrong with the words of a ready-made goal wherever parts stand when it is sought."""
    file, asked = goal_file(words[0]), Asked(setup, Observation(backend=""), words[0], tuple(words[1:]))
    try:
        if getattr(file, "ANYWHERE", False) or len(asked.words) < file.LEAST:
            made = made_ready(setup, asked.seen, words)
            yield from (wrong for _, wrong in goal_errors(setup, {made.name: made.goal}))
        for word in asked.words:
            asked.part(word.partition(".")[0])
    except PicoError as exc:
        yield from exc.diagnostics
