"""What a step of a recipe asks a person, and what is answered: the same at a terminal, in a page and behind a link."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal

SCHEMA = "pico.question/v1"
ASKED = "question.json"
"""The file in a folder of questions that holds the one which is asked now; there is none meanwhile."""


@dataclass(frozen=True)
class Question:
    """What a step asks, in words. `kind`: whether something is done (`confirm`: with "no" the step fails), or of which
    kind the value is that it wants, called `name`: true or false, a text, one of `choices` where there are any, or a
    number in `unit` from `low` to `high`; `default`: the value of who says nothing. `unattended`: what the step does
    where nobody is there."""

    path: str
    text: str
    kind: Literal["confirm", "number", "bool", "text"] = "confirm"
    name: str = ""
    unit: str = ""
    default: Any = None
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    unattended: str = "fail"


@dataclass(frozen=True)
class Answer:
    """What was answered, and by whom where somebody is known by name."""

    value: Any
    by: str = ""


def wanted(question: Question) -> str:
    """Return what an answer may be, in a few words."""
    if question.kind in ("confirm", "bool"):
        return "yes or no"
    if question.choices:
        return f"one of {', '.join(question.choices)}"
    if question.kind == "text":
        return "a text"
    said = f"a number in {question.unit}" if question.unit else "a number"
    ends = [("from", question.low), ("to", question.high)]
    return " ".join([said, *(f"{end} {value:g}" for end, value in ends if value is not None)])


def data(question: Question, number: str) -> dict[str, Any]:
    """Return schema `pico.question/v1`: the question that is asked under an id, and what an answer may be in words
    (`wanted`). It is over with the next document that the recipe says, and with its end."""
    return {"schema": SCHEMA, "id": number, **asdict(question), "wanted": wanted(question)}


def answer_at(folder: Path, number: str) -> Path:
    """Return the file in a folder of questions that the answer to the one of an id comes as: `value`, `by`."""
    return folder / f"answer-{number}.json"


def question_of(document: Mapping[str, Any]) -> Question:
    """Return the question of a document; raises ValueError for one that is none."""
    try:
        known = {name: document[name] for name in Question.__dataclass_fields__}
        return Question(**{**known, "choices": tuple(known["choices"])})
    except (KeyError, TypeError) as exc:
        raise ValueError(f"no question: {exc}") from exc
