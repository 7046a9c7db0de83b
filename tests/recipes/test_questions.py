"""What a recipe asks a person: which answers are taken, in which unit, and what is wrong with the others."""

from __future__ import annotations

import json
from typing import Any, cast

import pytest
from asking import asked as walked
from asking import read, right

from pico.bench.bench import Bench
from pico.diagnostics import PicoError
from pico.model.trace.question import Answer, Question, data, question_of
from pico.recipes.doing import Doing
from pico.recipes.parameters import answered
from pico.recipes.recipe import Act, Recipe
from pico.recipes.steps import prompt

CONFIRM = Question("1", "Put the sample in.")
ROUND = Question("1", "Is the spot round?", "bool", "round")
POWER = Question("1", "Read the meter.", "number", "power", "mW", low=0.0, high=5.0)
SAMPLE = Question("1", "Which sample?", "text", "sample", choices=("glass", "gold"))
NOTED = Question("1", "What do you see?", "text", "seen", default="nothing")


@pytest.mark.parametrize(
    ("question", "word", "value"),
    [
        (CONFIRM, "yes", True), (CONFIRM, " N ", False), (ROUND, "no", False), (POWER, "2.5", 2.5),
        (POWER, "400 uW", 0.4), (POWER, "1 + 1", 2.0), (POWER, "sqrt(4)", 2.0), (SAMPLE, "gold", "gold"),
        (NOTED, "a ring: ${x} [3", "a ring: ${x} [3"), (NOTED, "", "nothing"),
    ],
)  # fmt: skip
def test_an_answer_is_taken_as_a_person_writes_it(question: Question, word: str, value: Any) -> None:
    found = answered(question, word)
    assert found == (pytest.approx(value) if isinstance(value, float) else value)
    assert answered(question_of(json.loads(json.dumps(data(question, "q1")))), word) == found


@pytest.mark.parametrize(
    ("question", "word", "code", "said"),
    [
        (CONFIRM, "maybe", "answer", "neither yes nor no"), (CONFIRM, "", "answer", "neither yes nor no"),
        (POWER, "6", "range", "power is out of range: 6 mW, and it may be 0 to 5 mW"),
        (POWER, "2 mm", "unit", "not a length"), (POWER, "much", "expression", "nothing is called `much`"),
        (POWER, "", "answer", "nothing is said of power"), (POWER, "[1, 2]", "type", "and this is numbers"),
        (SAMPLE, "silver", "range", "one of glass, gold"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_an_answer_is_said(question: Question, word: str, code: str, said: str) -> None:
    with pytest.raises(PicoError) as refused:
        answered(question, word)
    (found, *_) = refused.value.diagnostics
    assert found.code == code and said in found.summary, found


def test_what_is_asked_for_is_read_as_a_parameter_is_and_known_in_its_unit() -> None:
    recipe = right("steps:\n- {prompt: 'Read ${1 + 1}.', unit: mW, range: [0, 5 W], as: read}\n"
                   "- {prompt: Which?, choices: [glass, gold], as: which}\n"
                   "- {prompt: Round?, kind: bool, as: is_round}\n"
                   "- assert: read > 3 && which == 'gold' && is_round\n")  # fmt: skip
    first = recipe.steps[0]
    assert isinstance(first, Act) and (first.names[""].kind, first.names[""].unit) == ("number", "mW")
    assert first.given["about"] == {"kind": "number", "name": "read", "unit": "mW", "default": None, "low": 0.0,
                                    "high": 5000.0, "choices": ()}  # fmt: skip


@pytest.mark.parametrize(
    ("step", "code", "said"),
    [
        ("{prompt: Read., unit: mWatt, as: x}", "unit", "unit of x"),
        ("{prompt: Read., unit: mW, range: [0, 1 mm], as: x}", "unit", "range of x"),
        ("{prompt: Read., range: [0, 1], default: 3, as: x}", "range", "x is out of range"),
        ("{prompt: Read., kind: numbers, as: x}", "choice", "one value"),
        ("{prompt: Read., kind: nmber, as: x}", "choice", "no kind of value"),
        ("{prompt: Read., unit: mW, unattended: skip, as: x}", "missing-key", "has no value"),
        ("{prompt: Read., as: x}", "name", "no result"),
        ("{prompt: Read., unattended: never}", "choice", "`unattended` is `never`"),
    ],
)  # fmt: skip
def test_a_question_that_could_not_be_answered_is_told_before_anything_moves(step: str, code: str, said: str) -> None:
    _, found = read(f"steps:\n- {step}\n")
    assert any(one.startswith(f"2: {code}: ") and said in one for one in found), found


def told(step: str, **doing: Any) -> dict[str, Any]:
    """Return what a step told."""
    recipe = right(f"steps:\n- {step}\n")
    made = cast(Act, cast(Recipe, recipe).steps[0])
    given = {name: term.literal if name == "question" else term for name, term in made.given.items()}
    return dict(prompt.run(Doing(cast(Bench, None), step="1", **doing), given))


def test_who_answered_is_told_with_the_value_and_a_no_fails() -> None:
    asked: list[Question] = []

    def ask(question: Question) -> Answer:
        asked.append(question)
        return Answer(answered(question, "2"), "anna")

    assert told("{prompt: Read the meter., unit: mW, range: [0, 5], as: read}", ask=ask) == {"": 2.0, "by": "anna"}
    assert asked == [Question("1", "Read the meter.", "number", "read", "mW", low=0.0, high=5.0)]
    assert told("prompt: Put it in.", ask=lambda _: Answer(True, "anna")) == {"by": "anna"}
    with pytest.raises(PicoError, match="ben said no: Put it in"):
        told("prompt: Put it in.", ask=lambda _: Answer(False, "ben"))


def test_where_nobody_is_there_a_value_is_its_default_or_the_step_fails() -> None:
    assert told("{prompt: Read., unit: mW, default: 3, unattended: skip, as: x}") == {"": 3.0}
    assert told("{prompt: Look., unattended: skip}") == {}
    with pytest.raises(PicoError, match="nobody is there to be asked: Look"):
        told("prompt: Look.")


def test_what_was_answered_is_known_to_the_steps_that_follow() -> None:
    recipe = right("steps:\n- {prompt: Read., unit: deg, as: x}\n- set: {p1.angle: x / 2}\n")
    asks, _ = walked(recipe, lambda ask: {"": 5.0, "by": "anna"} if ask.path == "1" else {})
    assert asks[1] == ("2", {"p1.angle": 2.5})
