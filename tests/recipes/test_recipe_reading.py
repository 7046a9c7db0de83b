"""What is wrong with a recipe is said before anything moves, at its place."""

from __future__ import annotations

import pytest
from asking import read, right

from pico.recipes.recipe import Act


@pytest.mark.parametrize(
    ("text", "line", "code", "words"),
    [
        ("steps:\n- mesure: cam.centroid\n", 2, "step", "no step `mesure`"),
        ("steps:\n- {measure: cam.centroid, apply: e1}\n", 2, "step", "one thing"),
        ("steps:\n- measure: cam.centroud\n", 2, "unknown-measurable", "no measurable `centroud`"),
        ("steps:\n- measure: cat.centroid\n", 2, "unknown-component", "no component `cat`"),
        ("steps:\n- apply: e9\n", 2, "unknown-revision", "no revision `e9`"),
        ("steps:\n- set: {p1.angle: 2 kg}\n", 2, "unit", "an angle, not a mass"),
        ("steps:\n- set: {p1.angle: 361}\n", 2, "range", "out of range"),
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
        ("steps:\n- {scan: {p1.angle: [1, 400]}, read: cam.power}\n", 2, "range", "400 deg is outside"),
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


def test_all_mistakes_are_told_at_once() -> None:
    _, found = read("steps:\n- apply: e8\n- measure: cam.x\n- set: {p1.angle: 400}\n")
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
