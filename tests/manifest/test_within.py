"""The characters of a scalar's value are found where they stand in the text, however it is quoted or folded."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.manifest.text.source import Source
from pico.manifest.text.tree import Map, Scalar, parse
from pico.manifest.text.within import inside, places_of


def scalar(content: str) -> Scalar:
    root = parse(Source("a.yaml", content))[0][0].root
    assert isinstance(root, Map)
    found = root.get("a")
    assert isinstance(found, Scalar)
    return found


@pytest.mark.parametrize(("content", "line", "column"), [
    ("a: l[0] + l[x]\n", 1, 12),
    ("{b: 1, a: 'l[0] + l[x]'}\n", 1, 20),
    ("a: 'l[0] + ''y'' + l[x]'\n", 1, 21),
    ('a: "l[0] + \\u0079 + \\"l\\" + l[x]"\n', 1, 30),
    ("a: l[0]\n  + l[x]\n", 2, 6),
    ("a: |\n  l[0]\n    + l[x]\n", 3, 8),
    ("a: >-\n  l[0]\n  + l[x]\n", 3, 6),
    ('a: "l[0] \\\n   + l[x]"\n', 2, 7),
])  # fmt: skip
def test_a_part_of_a_text_is_found_though_the_same_stands_before_it(content: str, line: int, column: int) -> None:
    node = scalar(content)
    at = node.text.rindex("[")
    found = inside(Source("a.yaml", content), node, at, at + 1)
    assert (found.start.line, found.start.column) == (line, column)
    assert found.snippet[found.start.column - 1] == "["


SIGNS = "ab[]'\"\\ \n:#"


@given(st.text(alphabet=SIGNS, min_size=1, max_size=30), st.sampled_from(["'", '"', "|2", ">2"]))
def test_each_sign_has_a_place_where_it_stands(text: str, style: str) -> None:
    quoted = {
        "'": "'" + text.replace("'", "''").replace("\n", "\n\n  ") + "'",
        '"': '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"',
    }.get(style, f"{style}\n" + "".join(f"  {line}\n" for line in text.split("\n")))
    content = f"a: {quoted}\n"
    node = scalar(content)
    places = places_of(content, node)
    assert len(places) == len(node.text) + 1
    for sign, at in zip(node.text, places, strict=False):
        if not sign.isspace():
            assert content[at + (content[at] == "\\" and style == '"')] == sign
