"""`pico fmt` brings any layout to one, keeps what is said, and is done the first time."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from manifest_samples import GOOD, LAB, OWN_TYPE, STATE

from pico.diagnostics import PicoError
from pico.manifest.fmt import format_text
from pico.manifest.load import load_files
from pico.resources import catalog_dir, labs_dir

UNTIDY = """\

# the table of the shel bench

kind: LabState   # a state
apiVersion: pico/v1
components: # all
    # the second polarizer

    p2:     # in the focus
        angle: 90.0 # crossed
        pose: {yaw: 30, x: 1,
           # measured
           y: 2}
        # shutter: open

    # the lens
    lx: {slot: storage/a1}  # stowed
      # cleaned in May
    p1:
        slot: "storage/b1"


        angle:
            90
    # that is all
metadata: {lab: shel}
expect:
- {that: "a # b", message: no}
  # measured by hand
- that: |
    foo # no comment
    bar
  message: >-   # why
     folded
       text

     end
# tail
"""
TIDY = """\
# the table of the shel bench
apiVersion: pico/v1
kind: LabState   # a state
metadata: {lab: shel}
components: # all
  # the lens
  lx:  # stowed
    slot: storage/a1
    # cleaned in May
  p1:
    slot: "storage/b1"

    angle: 90
  # the second polarizer

  p2:     # in the focus
    pose:
      x: 1
      # measured
      y: 2
      yaw: 30
    angle: 90.0 # crossed
    # shutter: open
  # that is all
expect:
  - {that: "a # b", message: no}
    # measured by hand
  - that: |
      foo # no comment
      bar
    message: >-   # why
      folded
        text

      end
# tail
"""


def test_an_untidy_state_becomes_tidy_and_every_comment_goes_with_its_line() -> None:
    assert format_text(UNTIDY) == TIDY


@pytest.mark.parametrize(
    "path", [*labs_dir().rglob("*.yaml"), *catalog_dir().glob("*.yaml")], ids=lambda p: f"{p.parent.name}/{p.name}"
)
def test_what_we_ship_is_tidy(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert format_text(text) == text


@pytest.mark.parametrize("text", [LAB, STATE, OWN_TYPE, STATE + "---\n" + STATE])
def test_tidy_text_stays_as_it_is(text: str) -> None:
    assert format_text(text) == text


def test_line_ends_stay_and_a_byte_order_mark_goes() -> None:
    assert format_text("\ufeff" + UNTIDY.replace("\n", "\r\n")) == TIDY.replace("\n", "\r\n")


def test_yaml_of_other_programs_stays_as_it_is() -> None:
    text = "b:   1\na: [2,3]\n"
    assert format_text(text) == text


def test_broken_yaml_is_refused_with_its_place() -> None:
    with pytest.raises(PicoError) as caught:
        format_text("a: [1\nb: 2\n", "x.yaml")
    assert str(caught.value.diagnostics[0].source) == "x.yaml:2:2"


def test_the_state_says_the_same_afterwards() -> None:
    loose = STATE.replace(
        "    pose:\n      x: 290\n      y: 420\n      yaw: 0\n", "    pose: {yaw: 0, y: 420, x: 290}\n"
    )
    tidy = GOOD | {"state/table.yaml": format_text(loose).encode()}
    assert load_files(tidy).require() == load_files(GOOD).require()


# Random states as people lay them out: any order, indentation, flow or block, comments and blank lines anywhere.
INDENTS = st.integers(1, 5)
REMARKS = st.sampled_from(["", "", "", "  # note", " # x: 1", "\t# é"])
ABOVE = st.sampled_from(["", "", "", "\n", "# above\n", "\n# one\n\n# two\n", "        # deep\n"])


@st.composite
def layouts(draw: st.DrawFn) -> str:
    outer, inner = draw(INDENTS), draw(INDENTS)
    lines = [draw(ABOVE), "apiVersion: pico/v1\n", draw(ABOVE), "kind: LabState", draw(REMARKS), "\n"]
    lines += ["metadata: {lab: bench}\n", draw(ABOVE), "components:", draw(REMARKS), "\n"]
    for name in draw(st.permutations(["p1", "p2", "laser", "a", "zz"])):
        pad, deep = " " * outer, " " * (outer + inner)
        lines.append(draw(ABOVE))
        style = draw(st.sampled_from(["flow", "block", "empty", "wide"]))
        if style == "flow":
            lines += [f"{pad}{name}: {{slot: s/1, angle: 4, pose: {{y: 1, x: 2}}}}", draw(REMARKS), "\n"]
        elif style == "wide":
            lines += [
                f"{pad}{name}: {{slot: s/1,",
                draw(REMARKS),
                f"\n{deep}angle: 4",
                draw(REMARKS),
                f"\n{deep}}}",
                draw(REMARKS),
                "\n",
            ]
        elif style == "empty":
            lines += [f"{pad}{name}:", draw(REMARKS), "\n"]
        else:
            lines += [f"{pad}{name}:", draw(REMARKS), "\n"]
            for key, value in draw(
                st.permutations([("angle", "'9'"), ("z", "true"), ("pose", "{x: 1, y: 2}"), ("b", f"\n{deep} 5")])
            ):
                lines += [draw(ABOVE), f"{deep}{key}: {value}", draw(REMARKS), "\n"]
    return "".join(
        [*lines, draw(ABOVE), draw(st.sampled_from(["", "expect:\n- {that: a}\n", "expect: []\n"])), draw(ABOVE)]
    )


@given(layouts())
def test_formatting_twice_is_formatting_once(text: str) -> None:
    once = format_text(text)  # which itself refuses to lose a value or a comment
    assert format_text(once) == once
    assert once.count("#") == text.count("#")
