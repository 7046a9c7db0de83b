"""Error budgets: derivatives against theory, sums against draws, and what would have to be held tighter."""

from __future__ import annotations

import math
import statistics
from dataclasses import replace

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from pico.diagnosis.budget import Contribution, ErrorBudget, error_budget, tighter
from pico.diagnosis.claims import Budgeted, budgeted, judged, uncarried
from pico.diagnosis.nominal import Nominal
from pico.diagnostics import PicoError
from pico.geometry.seat import drawn
from pico.manifest.load import load_folder
from pico.model.goal import Claim
from pico.model.state import ComponentState, LabState
from pico.optics.light import light_of
from pico.optics.unseen import SEEN
from pico.resources import labs_dir

SHIFT = "(plus.cam.centroid.y - minus.cam.centroid.y) / 2"
CROSSED = {"plus": {"p1.angle": 1.0}, "minus": {"p1.angle": 179.0}}
"""p1 one degree to either side of 0: p2 passes 90."""
LEAKS = math.sqrt(1e-5)
"""The amplitude of the other polarization that p1 lets through [1, in phase]: its extinction is 1e5."""
WIDTH, FIRST, SECOND, WAVE = 0.65, 125.0, 150.0, 632.8e-6  # mm
BEFORE, BEHIND, PLATE = 1.55, 0.5, 0.333
"""Where the principal planes of the second lens are, from its middle, and by how much glass shortens the way [mm]."""


class Theory:
    """The spin Hall shift of a Gaussian beam at a tilted polarizer near crossed [um], and its derivatives by hand.

    A plane wave that goes up by an angle a passes with the amplitude t + a T, with t = tan(delta), T = tan(tilt): a
    tilted polarizer is turned for it by a T. The power of the beam is Gaussian over a, with the variance
    s = (w/f1)^2/4 + (lambda/(pi w))^2/4 of a beam of radius w behind a lens of focal length f1. So its mean angle is
    2 t T s / (t^2 + T^2 s + e), e the leak; and the amplitude being real, it goes by the waist in the middle, and
    reaches the camera L = a + b (1 - a/f2) beside it, a before and b behind the second lens. (README of the lab; Aiello
    and Woerdman, Opt. Lett. 33, 1437, 2008, for the weighting of plane waves.)
    """

    def __init__(self, tilt: float, delta: float, waist: float, lens: float, camera: float) -> None:
        self.t, self.T = math.tan(math.radians(delta)), math.tan(math.radians(tilt))
        self.s = ((WIDTH / FIRST) ** 2 + (WAVE / math.pi / WIDTH) ** 2) / 4
        self.a, self.b = lens - BEFORE - PLATE - waist, camera - lens + BEHIND
        self.D = self.t**2 + self.T**2 * self.s + 1e-5

    @property
    def lever(self) -> float:
        return self.a + self.b * (1 - self.a / SECOND)

    @property
    def angle(self) -> float:
        return -2000 * self.T * self.t * self.s / self.D

    @property
    def by_delta(self) -> float:  # um/deg
        slope = self.T * self.s * (1 + self.t**2) * (self.D - 2 * self.t**2) / self.D**2
        return -2000 * self.lever * slope * math.radians(1)

    @property
    def by_tilt(self) -> float:  # um/deg
        slope = self.t * self.s * (1 + self.T**2) * (self.D - 2 * self.T**2 * self.s) / self.D**2
        return -2000 * self.lever * slope * math.radians(1)

    @property
    def by_waist(self) -> float:  # um/mm
        return -self.angle * (1 - self.b / SECOND)

    @property
    def by_lens(self) -> float:  # um/mm
        return self.angle * ((1 - self.b / SECOND) - (1 - self.a / SECOND))


def sides(nominal: Nominal, tilt: float, delta: float) -> tuple[Theory, Theory]:
    """Return theory for both sides of where p1 is set; its leak is as if it were turned by so much more."""
    x = {name: pose.x for name, pose in nominal.poses.items()}
    leak = math.degrees(LEAKS)
    plus, minus = (Theory(tilt, d + leak, x["lx_125"] + FIRST, x["ly_150"], x["cam"]) for d in (delta, -delta))
    return plus, minus


@pytest.mark.parametrize(("tilt", "delta"), [
    (30.0, 1.0), pytest.param(20.0, 1.5, marks=pytest.mark.slow), pytest.param(40.0, 0.8, marks=pytest.mark.slow),
])  # fmt: skip
def test_derivatives_of_the_spin_hall_shift_are_those_of_theory(nominal: Nominal, tilt: float, delta: float) -> None:
    tilted = {**nominal.poses, "p2": replace(nominal.poses["p2"], yaw=tilt)}
    bench = Nominal(nominal.setup, tilted, nominal.values)
    found = error_budget(bench, SHIFT, {"plus": {"p1.angle": delta}, "minus": {"p1.angle": 180 - delta}})
    plus, minus = sides(bench, tilt, delta)
    by = {(row.address, row.look): row.derivative for row in found.rows}

    assert found.value == pytest.approx((plus.lever * plus.angle - minus.lever * minus.angle) / 2, rel=0.02)
    assert by["p1.angle", "plus"] == pytest.approx(plus.by_delta / 2, rel=0.02)
    assert by["p1.angle", "minus"] == pytest.approx(-minus.by_delta / 2, rel=0.02)
    assert by["p2.pose.yaw", ""] == pytest.approx((plus.by_tilt - minus.by_tilt) / 2, rel=0.02)
    assert by["lx_125.pose.x", ""] == pytest.approx((plus.by_waist - minus.by_waist) / 2, rel=0.02)
    assert by["ly_150.pose.x", ""] == pytest.approx((plus.by_lens - minus.by_lens) / 2, rel=0.02)
    assert by["p1.roll", ""] == pytest.approx((plus.by_delta - minus.by_delta) / 2, rel=0.05)
    assert abs(by["p2.pose.x", ""]) < 0.01  # the waist is where the shift begins, not the polarizer


def test_about_the_null_what_turns_both_sides_alike_tells_nothing(nominal: Nominal) -> None:
    null = -math.degrees(LEAKS)
    found = error_budget(nominal, SHIFT, {"plus": {"p1.angle": null + 1}, "minus": {"p1.angle": null + 179}})
    by = {(row.address, row.look): abs(row.derivative) for row in found.rows}
    assert by["p1.roll", ""] < 0.05 * by["p1.angle", "plus"]
    assert by["p1.angle", "plus"] == pytest.approx(by["p1.angle", "minus"], rel=0.05)


def test_the_sum_is_what_parts_that_are_put_down_at_random_do(nominal: Nominal) -> None:
    """Against placements as the twin draws them, all parts at once, without the steps of the budget."""
    setup, parts = nominal.setup, ("p1", "lx_125", "p2", "ly_150")
    found = error_budget(nominal, "cam.centroid.y")
    placed = [
        r for r in found.rows if r.address.split(".")[0] in parts and not r.address.endswith(("angle", "stage_z"))
    ]
    expected = math.hypot(*(row.repeated or 0.0 for row in placed))

    def once(seed: int) -> float:
        off = {name: drawn(setup, name, seed, 1) for name in parts}
        poses = nominal.poses | {name: one.of(nominal.poses[name]) for name, one in off.items()}
        seats = {n: SEEN.sitting(one.seat(1), setup.type_of(n).frames.optical) for n, one in off.items()}
        (arrival,) = light_of(setup, poses, nominal.values, unseen=seats).at("cam")
        return 1e3 * arrival.center[1]

    assert statistics.stdev(once(seed) for seed in range(80)) == pytest.approx(expected, rel=0.25)


def test_what_is_not_in_proportion_is_said_and_counted_as_it_is(nominal: Nominal) -> None:
    at_null = {**nominal.values, "p1": {"angle": -math.degrees(LEAKS)}}
    found = error_budget(Nominal(nominal.setup, nominal.poses, at_null), "cam.power")
    (row,) = [r for r in found.rows if r.address == "p1.angle"]
    assert row.bent and row.tolerated and row.tolerated > 3 * abs(row.derivative) * 0.1 / math.sqrt(3)


@pytest.mark.parametrize(("of", "unit"), [
    ("cam.centroid.y", "um"), ("cam.power", "mW"), ("cam.width.major / cam.width.minor", ""), ("cam.fit.x * 2", "um"),
])  # fmt: skip
def test_a_result_has_the_unit_of_its_numbers_where_it_grows_as_they_do(nominal: Nominal, of: str, unit: str) -> None:
    assert error_budget(nominal, of).unit == unit


@pytest.mark.parametrize(("of", "said"), [
    ("cam.centroid.z", "did you mean `cam.centroid."), ("cam.saturation", "does not tell cam.saturation"),
    ("1 + 1", "nothing that is measured"), ("cam.centroid.x >", "can't be told"), ("a.cam.power", "nothing is called"),
    ("cam.centroid.x / 0", "no value"),
])  # fmt: skip
def test_what_is_no_result_is_refused_in_words(nominal: Nominal, of: str, said: str) -> None:
    with pytest.raises(PicoError) as caught:
        error_budget(nominal, of)
    assert said in caught.value.diagnostics[0].summary


def rows(*effects: float) -> tuple[Contribution, ...]:
    return tuple(Contribution(f"p{n}.pose.x", "", "mm", e, 1.0, 1e-3, e, e, False) for n, e in enumerate(effects))


@given(st.lists(st.floats(1e-6, 1e3), min_size=1, max_size=8), st.floats(1e-3, 2.0))
@example([1.0, 1.5], 1.0)
def test_what_is_held_as_it_says_leaves_what_is_wanted(effects: list[float], share: float) -> None:
    budget = ErrorBudget("x", {}, 1.0, "um", rows(*effects))
    wanted = share * budget.tolerated
    held = {one.address: one.to / one.was for one in tighter(budget, wanted)}
    left = [(row.tolerated or 0.0) * held.get(row.address, 1.0) for row in budget.rows]
    assert all(0 < one <= 1 for one in held.values()) and bool(held) == (wanted < budget.tolerated)
    assert math.hypot(*left) == pytest.approx(min(wanted, budget.tolerated), rel=1e-9)
    others = [size for row, size in zip(budget.rows, left, strict=True) if row.address not in held]
    assert all(
        size <= max(left) * (1 + 1e-9) for size in others
    )  # none that is left alone does more than one that is held


def test_of_a_result_that_is_zero_there_is_no_share_and_light_that_may_be_lost_carries_nothing() -> None:
    nothing = ErrorBudget("x", {}, 0.0, "um", rows(1.0))
    with pytest.raises(PicoError, match="is 0 in this state"):
        judged(nothing, "2 %")
    assert judged(nothing, "2 um").carried and not judged(nothing, 0.5).carried
    lost = ErrorBudget("x", {}, 1.0, "um", (replace(rows(1.0)[0], tolerated=None),))
    assert lost.lost == ("p0.pose.x",) and not judged(lost, "2 um").carried and Budgeted("x").carried


@pytest.mark.parametrize("to", ["0 %", "-1 um", "2 kg", "many", "1 deg", "nan um"])
def test_what_is_neither_a_share_nor_a_size_is_refused(to: str) -> None:
    with pytest.raises(PicoError):
        judged(ErrorBudget("x", {}, 1.0, "um", rows(1.0)), to)


def test_a_claim_is_warned_about_where_the_tolerances_do_not_carry_it(nominal: Nominal) -> None:
    lab = replace(nominal.setup.lab, claims={
        "shift": Claim(of=SHIFT, looks=CROSSED, to="2 %"), "rough": Claim(of="cam.power", to="50 %"),
    })  # fmt: skip
    setup = replace(nominal.setup, lab=lab)
    parts = {
        name: ComponentState(pose=pose, values=dict(nominal.values.get(name, {})))
        for name, pose in nominal.poses.items()
    }
    ((name, said),) = uncarried(setup, LabState(lab="shel", components=parts))
    assert name == "shift" and "p1.angle to ± 0.02" in said.hint and "4.9 %" in said.detail
    without = {name: part for name, part in parts.items() if name != "laser"}
    moved = {**without, "laser": replace(parts["laser"], pose=replace(nominal.poses["laser"], yaw=90))}
    assert not [*uncarried(setup, LabState(lab="shel", components=moved))]  # in the dark nothing is told


def test_a_set_point_that_light_finds_must_be_supposed() -> None:
    from pico.model.state import LightReference

    setup, state = load_folder(labs_dir() / "shel").require()
    found = replace(
        state.components["p1"], values={}, by_light={"angle": LightReference(null_of=("p1", "p2"), offset=1)}
    )
    by_light = replace(state, components={**state.components, "p1": found})
    with pytest.raises(PicoError, match=r"light finds p1\.angle"):
        budgeted(setup, by_light, "cam.centroid.y")
    assert budgeted(setup, by_light, "cam.centroid.y", at={"p1.angle": "91 deg"}).value == pytest.approx(0, abs=1e-6)
