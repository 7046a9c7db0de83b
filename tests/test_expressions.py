"""Expressions: one kind of number, mistakes found before evaluation and shown at their place, limited work."""

from __future__ import annotations

import re
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.expressions import ExpressionError, Function, Language, UnknownValue

VALUES: dict[str, Any] = {
    "p1": "p1", "p2": "p2", "p2.angle": 30, "p2.pose.x": 5, "p2.open": True,
    "operations": [{"mass": 1, "tags": ["a", "b"]}, {"mass": 2, "tags": []}],
    "components": {"p1": {"mass": 3, "places": [1, 2]}},
}  # fmt: skip


@pytest.fixture(scope="module")
def language() -> Language:
    kinds: dict[str, Any] = {
        "p1": "text", "p2": "text", "p2.angle": "number", "p2.pose.x": "number", "p2.open": "bool",
        "cam.peak": "number", "operations": "list", "components": "any",
    }  # fmt: skip
    return Language(kinds, [Function("distance", ("text", "text"), "number", distance)])


def distance(a: str, b: str) -> float:
    if a == b:
        raise ValueError(f"{a} is no distance from itself")
    return 3.5


@pytest.mark.parametrize("text", [
    "p2.angle == 30", "p2.angle > 29 && p2.angle < 3.1e1", "p2.angle in [30, 31]", "distance(p1, p2) > 3",
    "size(operations) == 2", "operations.size() == 2", "operations[1].mass == 2", "operations[0].tags[1] == 'b'",
    "operations.all(o, o.mass <= 2)", "components[p1].mass == 3", "components.p1.places[0] == 1",
    "operations[size(operations) - 1].mass == 2", "operations[int(p2.angle / 20)].mass == 2",
    "[[1, 2], [3]][size(operations) - 1][int('0')] == 3", "size(operations) - int(1.9) == 1",
    "operations[operations[0].mass].mass == operations[ size(operations[0].tags) - 1 ].mass // 2",
    "p2.open || cam.peak > 200", "'1' == \"1\"", "operations.exists(o, size(o.tags) == 2) // 2 tags",
])  # fmt: skip
def test_integers_and_doubles_are_one_kind_of_number(language: Language, text: str) -> None:
    assert language.compile(text).evaluate(VALUES) is True


@pytest.mark.parametrize(("text", "part", "said"), [
    ("p2.angel > 1", "p2.angel", "did you mean `p2.angle`?"),
    ("p2.angle > 1 && p3 == 'x'", "p3", "nothing is called `p3`"),
    ("p2.angle > 'x'", ">", "a number and text"),
    ("10 < 20 && p2.angle ==", "", "ends too early"),
    ("p2.angle + 1", "p2.angle + 1", "a number, not true or false"),
    ("distance(p1) > 1", "distance", "this many arguments"),
    ("1 < 2 && nearest(p1) > 1", "nearest", "no function `nearest`"),
    ("operations['a'].mass == 1 && operations[size(operations) - 1].mass == 2", "[", "a list and text"),
    ("1 + 1 == 2 && p2.angle > 'x'", ">", "a number and text"),
])  # fmt: skip
def test_mistakes_are_found_without_evaluating_and_at_their_place(
    language: Language, text: str, part: str, said: str
) -> None:
    with pytest.raises(ExpressionError) as caught:
        language.compile(text)
    assert said in str(caught.value)
    assert text[caught.value.start : caught.value.end] == part


@pytest.mark.parametrize(("text", "hint"), [
    ("operations['a'].mass > 1", "a whole number"), ("p2.angle % 2 == 1", "mod(a, b)"),
    ("'a' + 1 == 'a1'", "string(x)"),
    ("max([1, 2]) > 1", "most(l)"), ("p2.open and p2.open", "`&&`"), ("p2.angle ** 2 == 1", "`x * x`"),
    ("p2.angle = 3", "`==`"), ("p2.angle", "a comparison"), ("distance(p1) > 1", "`distance(text, text)`"),
    ("last(operations) == 1", "l[size(l) - 1]"), ("size() > 1", "size(l)"), ("size(1) > 1", "size(l)"),
])  # fmt: skip
def test_a_mistake_comes_with_what_would_be_right(language: Language, text: str, hint: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        language.compile(text)
    assert hint in caught.value.hint


def test_what_is_not_known_is_named(language: Language) -> None:
    with pytest.raises(UnknownValue) as caught:
        language.compile("p2.angle > 1 && cam.peak > 200").evaluate(VALUES)
    assert caught.value.name == "cam.peak"


@pytest.mark.parametrize(("text", "said"), [
    ("components.p1.weight > 1", "there is no `weight` in it"),
    ("distance(p1, p1) > 1", "p1 is no distance from itself"),
    ("operations.all(o, o.tags)", "not go together"),
    ("operations[7].mass > 1", "`operations` has 2 values, so `operations[7]` does not exist"),
    ("operations[p2.pose.x - 6].mass > 1", "`operations[-1]` does not exist"),
    ("operations[p2.angle / 100].mass > 1", "a whole number"),
    ("int('two') > 1", "`two` is no number"),
])  # fmt: skip
def test_an_evaluation_without_a_result_says_why(language: Language, text: str, said: str) -> None:
    with pytest.raises(ExpressionError, match=re.escape(said)):
        language.compile(text).evaluate(VALUES)


def test_the_work_of_an_expression_is_limited(language: Language) -> None:
    with pytest.raises(ExpressionError, match="too deep"):
        language.compile("1+" * 60 + "1 > 2")
    with pytest.raises(ExpressionError, match="4096 bytes"):
        language.compile("p2.open" + " " * 5000)
    many = {**VALUES, "operations": [{"mass": 1}] * 300}
    with pytest.raises(ExpressionError, match="10,000 steps"):
        language.compile("operations.all(a, operations.all(b, a.mass == b.mass))").evaluate(many)


@given(st.text(alphabet="p12.angle()[]{}'\"<>=&|!?:,+-*/% \n\\sizeof", max_size=60))
def test_any_text_is_an_expression_or_a_mistake_within_it(text: str) -> None:
    language = Language({"p1": "text", "p2.angle": "number", "operations": "list"})
    try:
        language.compile(text, "any").evaluate({"p1": "p1", "p2.angle": 1.0, "operations": []})
    except ExpressionError as exc:
        assert 0 <= exc.start <= len(text)


@given(st.integers(-(10**9), 10**9), st.floats(-1e9, 1e9))
def test_an_integer_compares_with_a_double_as_in_arithmetic(whole: int, other: float) -> None:
    language = Language({"x": "number"})
    assert language.compile(f"x < {whole}").evaluate({"x": other}) == (other < whole)
