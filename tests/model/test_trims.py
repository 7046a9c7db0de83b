"""A trim is symmetric and follows the period; a value that light has the last word on is no difference."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.manifest.catalog import load_catalog
from pico.model.catalog import Restore, Tunable
from pico.model.diff import diff_observed, value_deviation, within_trim
from pico.model.lab import Lab, Part, Slot, Table
from pico.model.observation import Aligned, Observation, ObservedComponent, ObservedValue
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState

CATALOG = load_catalog()
VALUES = st.floats(-70, 70)


def kind(trim: float | None, period: float | None = None, how: str = "align") -> Tunable:
    restore = Restore(kind=how, trim=trim)  # type: ignore[arg-type]
    return Tunable(unit="mrad", tolerance=0.05, period=period, restore=restore)


@given(a=VALUES, b=VALUES, trim=st.floats(0, 100), period=st.sampled_from([None, 30.0]))
def test_it_is_symmetric_and_follows_the_period(a: float, b: float, trim: float, period: float | None) -> None:
    assert within_trim(kind(trim, period), a, b) == within_trim(kind(trim, period), b, a)
    assert within_trim(kind(trim), a, a)
    if period:
        assert within_trim(kind(trim + 1e-6, period), a + period, b) >= within_trim(kind(trim, period), a, b)


@given(a=VALUES, b=VALUES, trim=st.floats(0, 100), more=st.floats(0, 10))
def test_a_wider_trim_takes_in_all_that_a_narrower_one_does(a: float, b: float, trim: float, more: float) -> None:
    assert within_trim(kind(trim + more), a, b) >= within_trim(kind(trim), a, b)


@given(a=VALUES, b=VALUES)
def test_without_a_trim_or_of_a_set_point_nothing_is_within_it(a: float, b: float) -> None:
    assert not within_trim(kind(None), a, b) and not within_trim(kind(200, how="setpoint"), a, b)


def bench(own: dict[str, Restore] | None = None) -> Setup:
    part = Part(type="mirror_tip_tilt", home="a", restore=own)
    lab = Lab(name="x", table=Table(size=(500, 500)), slots={"a": Slot(x=100, y=100)}, robots={}, inventory={"m": part})
    return Setup(lab=lab, catalog=CATALOG)


def seen(tip: float, aligned: bool) -> Observation:
    part = ObservedComponent(pose=Pose(100, 100), values={"tip": ObservedValue(value=tip)})
    met = {"m.tip": Aligned(goal="centred", at="2026-11-01T08:00:00+00:00")} if aligned else None
    return Observation(backend="sim", components={"m": part}, aligned=met)


WANTED = LabState(lab="x", components={"m": ComponentState(slot="a", values={"tip": 0.0})})


@given(tip=VALUES, exact=st.booleans(), aligned=st.booleans())
def test_what_light_has_the_last_word_on_is_tolerated_beyond_its_tolerance_unless_exact(
    tip: float, exact: bool, aligned: bool
) -> None:
    setup = bench({"tip": Restore(kind="align", trim=12.0)})
    found = diff_observed(setup, seen(tip, aligned), WANTED, exact=exact)
    off = value_deviation(setup.type_of("m").tunables["tip"], tip, 0.0)
    assert bool(found) == (off != "none")
    for change in found:
        stays = aligned and off == "off" and not exact
        assert (change.aligned is not None) == stays
        assert change.tolerated == (stays or (off == "tolerated" and not exact))


def test_a_part_says_its_own_trim_and_is_the_same_type_each_time() -> None:
    setup = bench({"tip": Restore(kind="align", trim=12.0, goal="g")})
    kinds = setup.type_of("m").tunables
    assert kinds["tip"].restore == Restore(kind="align", trim=12.0, goal="g")
    assert kinds["tilt"] == CATALOG["mirror_tip_tilt"].tunables["tilt"]
    assert setup.type_of("m") is setup.type_of("m")
    assert bench().digest() != setup.digest() and bench().digest() == bench(None).digest()


@pytest.mark.parametrize("how", ["setpoint", "none"])
def test_another_restore_is_of_its_own_too(how: str) -> None:
    assert bench({"tip": Restore(kind=how)}).type_of("m").tunables["tip"].restore.kind == how  # type: ignore[arg-type]
