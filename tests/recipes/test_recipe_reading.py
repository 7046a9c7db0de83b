"""What is wrong with a recipe is said before anything moves, at its place."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from asking import HEAD, SHEL, asked, read, right

from pico.expressions import CONVERSIONS
from pico.manifest.text.source import Source
from pico.recipes.reading import read_recipe
from pico.recipes.recipe import Act
from pico.recipes.scope import function_names


@pytest.mark.parametrize(
    ("text", "line", "code", "words"),
    [
        ("steps:\n- mesure: cam.centroid\n", 2, "step", "no step `mesure`"),
        ("steps:\n- {measure: cam.centroid, apply: e1}\n", 2, "step", "one thing"),
        ("steps:\n- measure: cam.centroud\n", 2, "unknown-measurable", "no measurable `centroud`"),
        ("steps:\n- measure: cat.centroid\n", 2, "unknown-component", "no component `cat`"),
        ("steps:\n- apply: e9\n", 2, "unknown-revision", "no revision `e9`"),
        ("steps:\n- set: {p1.angle: 2 kg}\n", 2, "unit", "an angle, not a mass"),
        ("steps:\n- set: {p1.angle: 721}\n", 2, "range", "out of range"),
        ("steps:\n- set: {p1.angel: 3}\n", 2, "unknown-tunable", "no tunable `angel`"),
        ("steps:\n- set: {p1.angle: tlit}\n", 2, "expression", "nothing is called `tlit`"),
        ("steps:\n- set: {laser.shutter: ajar}\n", 2, "choice", "shutter of laser"),
        ("steps:\n- set: {p1.angle: cam.centroid.x}\n", 2, "unmeasured", "nothing measures cam.centroid.x"),
        ("parameters: {t: {unit: mm, default: 1}}\nsteps:\n- set: {p1.angle: t}\n", 3, "unit", "`t` in mm"),
        ("parameters: {t: {unit: deg, default: 9, range: [0, 5]}}\nsteps: [{apply: e1}]\n", 1, "range", "9 deg"),
        ("parameters: {cam: 3}\nsteps:\n- let: {p1: 3}\n", 3, "name", "`p1` is a component"),
        ("steps:\n- move: {laser: {x: 3}}\n", 2, "capability", "no arm can move laser"),
        ("steps:\n- move: {p2: storage/z9}\n", 2, "unknown-slot", "no slot `storage/z9`"),
        ("steps:\n- move: {p2: {z: 3}}\n", 2, "unknown-key", "unknown key `z`"),
        ("steps:\n- while: 1 < 2\n  steps: [{apply: e1}]\n", 2, "bound", "needs a bound"),
        ("steps:\n- if: 1 + 2\n  then: [{apply: e1}]\n", 2, "expression", "it is a number"),
        ("steps:\n- foreach: {t: 3}\n  steps: [{apply: e1}]\n", 2, "type", "not a list"),
        ("steps:\n- foreach: {t: {from: 0, to: 9, step: -1}}\n  steps: [{wait: 1}]", 2, "range", "no values"),
        ("steps:\n- foreach: {t: {from: 0, to: 1e300, step: 1e-300}}\n  steps: [{wait: 1}]", 2, "range", "too many"),
        ("steps:\n- foreach: {t: {from: 0, to: 9, step: 1 + 'a'}}\n  steps: [{wait: 1}]", 2, "expression", "step of t"),
        ("steps:\n- foreach: {t: {from: 0, to: 9}}\n  steps: [{wait: 1}]", 2, "range", "no range"),
        ("steps:\n- foreach: {t: [1, nobody]}\n  steps: [{wait: 1}]", 2, "expression", "nothing is called `nobody`"),
        ("steps:\n- foreach: {t: [1 + 1, \"'a'\"]}\n  steps: [{wait: 1}]", 2, "type", "numbers in it, or texts"),
        ("steps:\n- scan: {p1.angle: [1 + 1, nobody]}\n  read: cam.power", 2, "expression", "called `nobody`"),
        ("parameters: {t: {unit: deg, default: 1 / }}\nsteps: [{wait: 1}]", 1, "expression", "ends too early"),
        ("steps:\n- foreach: {t: {from: 0, to: 9, count: 2.5}}\n  steps: [{wait: 1}]", 2, "range", "whole number"),
        ("steps:\n- foreach: {in: [1, 2]}\n  steps: [{wait: 1}]", 2, "name", "a word of expressions"),
        ("parameters: {bytes: 1}\nsteps:\n- wait: 1 + 1", 1, "name", "a word of expressions"),
        ("steps:\n- let: {a: 1}\n- let: {a: 2 > 1}\n", 3, "type", "was number before"),
        ("steps:\n- foreach: {t: [1, 2]}\n  steps:\n  - let: {one: t}\n- let: {a: one}\n", 5, "expression", "one"),
        ("steps:\n- {apply: e1, as: x}\n", 2, "name", "no result"),
        ("steps:\n- {measure: cam.centroid, retries: 1.5}\n", 2, "type", "whole number"),
        ("steps:\n- optimize: centred\n", 2, "goal", "no goal `centred`"),
        ("steps:\n- call: b\n", 2, "no-recipe", "no recipe `b`"),
        ("steps:\n- do: cam measure\n", 2, "step", "a step of its own"),
        ("steps:\n- {scan: {p1.angle: [1, 900]}, read: cam.power}\n", 2, "range", "900 deg is outside"),
        ("steps:\n- scan: {p1.angle: [1, 2]}\n", 2, "missing-key", "what to read"),
        ("steps:\n- {scan: {laser.shutter: [1, 2]}, read: cam.power}\n", 2, "type", "is no number"),
        ("steps:\n- teleop: p2.angel\n", 2, "unknown-tunable", "to be steered"),
        ("steps: 3\n", 1, "type", "no list of steps"),
        ("stps: []\n", 1, "unknown-key", "unknown key `stps`"),
        ("steps:\n- set: {p1.angle: \"'text'\"}\n", 2, "expression", "it is text"),
        ("steps:\n- branch: -d\n", 2, "name", "no name of a branch"),
    ],
)  # fmt: skip
def test_a_mistake_is_told_at_its_line(text: str, line: int, code: str, words: str) -> None:
    _, found = read(text)
    assert any(said.startswith(f"{line}: {code}: ") and words in said for said in found), found


def test_kernels_in_a_row_are_measured_and_their_numbers_have_units() -> None:
    chain = "cam.image | background | d4sigma"
    recipe = right("steps:\n- {measure: cam.image|background | d4sigma, as: spot}\n- let: {big: spot.major}\n"
                   "- assert: big > 3 && spot.major_sigma < 9\n- set: {p1.angle: spot.angle}\n")  # fmt: skip
    step = recipe.steps[0]
    assert isinstance(step, Act) and step.given["of"] == (chain,)
    assert {name: step.names[name].unit for name in ("major", "minor", "angle", "ellipticity", "angle_sigma")} == {
        "major": "um", "minor": "um", "angle": "deg", "ellipticity": "", "angle_sigma": "deg",
    }  # fmt: skip
    right(f"steps:\n- {{scan: {{p1.angle: [1, 2]}}, read: '{chain}', as: s}}\n"
          "- let: {a: least(s.cam_image_background_d4sigma_major)}\n")  # fmt: skip
    _, found = read(f"steps:\n- {{measure: '{chain}', as: spot}}\n- set: {{p1.angle: spot.major}}\n")
    assert found == ["3: unit: angle of p1 is in deg, and `spot.major` in um"]


@pytest.mark.parametrize(
    ("chain", "said"),
    [
        ("cam.image | d5sigma", "kernel: there is no kernel `d5sigma`"),
        ("cam.imago | d4sigma", "unknown-measurable: cam has no measurable `imago`"),
        ("cam.image | background", "kernel: `background` gives an image, no number"),
        ("cam.power | d4sigma", "kernel: cam.power is no picture: kernels have nothing to work on"),
        ("cam.image | stokes", "kernel: `stokes` takes readings, and `image` gives an image"),
    ],
)
def test_one_mistake_in_a_step_is_one_error(chain: str, said: str) -> None:
    step = f"steps:\n- {{measure: '{chain}', as: spot}}\n"
    _, found = read(step + "- assert: spot.major > 3\n- note: {p1: 'it is ${spot.major}'}\nreturns: {w: spot.minor}\n")
    assert found == [f"2: {said}"]


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ('steps:\n- let: {l: "[1, 2]"}\n- let: {a: "l[0] + l#[\'x\']"}\n', "#["),
        ("steps:\n- let: {l: '[1]'}\n- let: {s: 1, t: \"l[0] + ${l[0]#[1]}\"}\n", "#[1]"),
        ("steps:\n- let: {a: 1}\n- assert: 'a < 2 && #b < 2'\n", "#b"),
        ("steps:\n- let: {a: 1}\n- if: >-\n    a < 2 &&\n    a < #abc\n  then: [{wait: 1}]\n", "#abc"),
        ("steps:\n- foreach: {t: [1, 1 + 1, 1 + #other]}\n  steps: [{wait: 1}]\n", "#other"),
        ("steps:\n- foreach: {t: {from: 0, to: 2 + #two, count: 3}}\n  steps: [{wait: 1}]\n", "#two"),
    ],
)
def test_a_mistake_in_an_expression_is_shown_where_it_stands(text: str, part: str) -> None:
    """`#` marks the place; the same stands before it."""
    at = text.index(part) + part.index("#")
    lines = (HEAD + text[:at]).split("\n")
    source = Source("a.yaml", HEAD + text.replace("#", ""))
    _, found = read_recipe(source, SHEL, lambda *_: ("", b""))
    assert found[0].source is not None
    assert (found[0].source.start.line, found[0].source.start.column) == (len(lines), len(lines[-1]) + 1)


@pytest.mark.parametrize("values", [
    "{from: a, to: 3 * a, step: 1}", "{from: a, to: 6, count: size(l) + 1}", "range(a, 3 * a, 1)", "linspace(a, 6, 5)",
    "[a, 'l[size(l) - 4]', 4, 'l[0] + 2', 6]", "l.map(v, v - 1)",
])  # fmt: skip
def test_a_range_takes_expressions(values: str) -> None:
    text = (
        f'parameters: {{l: [3, 4, 5, 6], a: 2}}\nsteps:\n- let: {{found: "[]"}}\n- foreach: {{t: "{values}"}}\n'
        '  steps: [{let: {found: "found + [t]"}}]\nreturns: {found: found}\n'
    )
    recipe = right(text if values[0] not in "[{" else text.replace(f'"{values}"', values))
    assert asked(recipe)[1]["found"][:4] == [2, 3, 4, 5]


@pytest.mark.parametrize("text", [
    "parameters: {t: {default: 1, description: tilt of p2, from the front}}\nsteps: [{wait: 1}]\n",
    "steps:\n- {wait: 1, name: rest, then go on}\n",
])  # fmt: skip
def test_a_comma_that_ends_a_text_in_braces_is_told(text: str) -> None:
    _, found = read_recipe(Source("a.yaml", HEAD + text), SHEL, lambda *_: ("", b""))
    assert [d.code for d in found] == ["unknown-key"]
    assert "a comma ends a text" in found[0].hint


def test_what_a_loop_over_a_range_measures_is_counted_on() -> None:
    right(
        "parameters: {n: 3}\nsteps:\n- foreach: {t: {from: 1, to: n, step: 1}}\n  steps: [{measure: cam.power}]\n"
        "- assert: cam.power > 3\n"
    )


def test_a_default_may_be_an_expression_or_a_range() -> None:
    recipe = right(
        "parameters: {a: {unit: deg, default: 2 * 15}, l: {default: {from: 0, to: 2 * 3, count: 3}}}\n"
        "steps:\n- wait: 1\n"
    )
    assert recipe.parameters["a"].default == 30
    assert recipe.parameters["l"].default == [0, 3, 6]


def test_the_page_about_recipes_lists_the_functions_that_there_are() -> None:
    page = (Path(__file__).parents[2] / "docs" / "how-to" / "recipes.md").read_text()
    table = page.partition("| in expressions |")[2].partition("###")[0]
    assert set(re.findall(r"(?<![.\w])([a-z]\w*)\(", table)) == {*function_names(), *CONVERSIONS}


def test_all_mistakes_are_told_at_once() -> None:
    _, found = read("steps:\n- apply: e8\n- measure: cam.x\n- set: {p1.angle: 900}\n")
    assert len(found) == 3


def test_a_branch_that_a_step_makes_can_be_checked_out_after_it() -> None:
    right("steps:\n- branch: mine\n- checkout: mine\n")
    assert read("steps:\n- checkout: mine\n- branch: mine\n")[1]


def test_a_number_that_only_one_way_measures_is_not_counted_on() -> None:
    _, found = read("steps:\n- if: p1.angle > 3\n  then: [{measure: cam.power}]\n- assert: cam.power > 3\n")
    assert "nothing measures cam.power" in found[0]
    right("steps:\n- foreach: {t: [1, 2]}\n  steps: [{measure: cam.power}]\n- assert: cam.power > 3\n")


def test_a_recipe_that_is_called_is_read_as_well_and_told_what_it_needs() -> None:
    other = "parameters: {t: {unit: deg}}\nsteps: [{set: {p1.angle: t}}]\nreturns: {twice: 2 * t}\n"
    right("steps:\n- {call: b, with: {t: 3 deg}, as: c}\n- assert: c.twice > 5\n", {"b": other})
    assert "not told t" in read("steps:\n- call: b\n", {"b": other})[1][0]
    assert "no parameter `u`" in read("steps:\n- {call: b, with: {t: 1, u: 2}}\n", {"b": other})[1][0]
    assert "circle" in read("steps:\n- call: b\n", {"b": "steps: [{call: b}]\n"})[1][0]
    wrong = "steps:\n- measure: cam.x\n"
    assert "no measurable" in read("steps:\n- call: b\n", {"b": wrong})[1][0]


def test_the_digest_counts_what_is_called() -> None:
    one, other = (right("steps:\n- call: b\n", {"b": f"steps: [{{wait: {n} s}}]\n"}) for n in (1, 2))
    assert one.digest != other.digest


def test_a_scan_has_columns_of_a_pose_and_a_set_point_that_it_reads() -> None:
    right(
        "steps:\n- {scan: {p1.angle: [1, 2]}, read: [p2.angle, p2.pose], as: s}\n"
        "returns: {a: sum(s.p2_angle), b: sum(s.p2_pose_x), c: least(s.p2_pose_yaw_sigma)}\n"
    )
