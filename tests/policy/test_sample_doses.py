"""What light falls on a sample, and when operations would give it more than its budget: the rule, case by case.

The rule: the dose is power times time; within an operation the greater of the powers before and after it counts; what
was spent counts; a source that is not known to be dark shines; nothing is refused that only darkens the bench.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest
from laser_lab import UNKNOWN, bench, carry, commanded, observed, set_to

from pico.edge.dose import Ledger
from pico.manifest.catalog import load_catalog
from pico.model.catalog import Parameter
from pico.model.lab import Part
from pico.model.observation import ObservedComponent
from pico.model.operation import Operation, Reason
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.trace.dose import Dose
from pico.policy import dose

ON = {"emission": True, "shutter": "open"}


def held(budget: float | None = 10.0) -> Setup:
    """The bench with a sample in `holder`, in the beam of `laser`."""
    setup = bench()
    part = replace(setup.lab.inventory["holder"], sample="W1", dose_budget=budget)
    return replace(setup, lab=replace(setup.lab, inventory={**setup.lab.inventory, "holder": part}))


SETUP = held()


def one(spent: float = 0.0, power: float = 0.0, budget: float | None = 10.0) -> Dose:
    return Dose(sample="W1", component="holder", spent=spent, budget=budget, power=power)


def timed(operations: Sequence[tuple[Operation, float, float]]) -> list[Operation]:
    return [replace(op, id=f"op{n}", start=start, seconds=took) for n, (op, start, took) in enumerate(operations)]


def power(to: float) -> Operation:
    return set_to("laser", "power", to)


SHUT, OPENED = set_to("laser", "shutter", "closed"), set_to("laser", "shutter", "open")
ELSE = set_to("cam", "exposure", 3)


@pytest.mark.parametrize(("laser", "falls"), [
    (ON | {"power": 2.0}, 2.0), (ON | {"power": 0.5}, 0.5),
    ({"emission": True, "shutter": "closed", "power": 2.0}, 0.0),
    ({"emission": False, "shutter": "open", "power": 2.0}, 0.0),
    ({"emission": UNKNOWN, "shutter": "open", "power": 2.0}, 2.0),
    ({"emission": True, "shutter": commanded("closed"), "power": 2.0}, 2.0),
    ({"emission": UNKNOWN, "shutter": UNKNOWN, "power": 2.0}, 2.0),
])  # fmt: skip
def test_all_of_the_beam_falls_on_the_sample_unless_the_source_is_known_to_be_dark(laser: Any, falls: float) -> None:
    assert dose.powers(SETUP, observed(laser=laser)) == {"holder": pytest.approx(falls)}


def test_only_parts_with_a_sample_count_and_only_beams_that_come_to_them() -> None:
    seen = observed(laser=ON | {"power": 2.0}, second=ON | {"power": 50.0}, bare={"emission": True})
    assert dose.samples(SETUP) == {"holder": "W1"} and dose.powers(bench(), seen) == {}
    assert dose.powers(SETUP, seen) == {"holder": pytest.approx(2.0)}
    closed = observed(laser=ON | {"power": 2.0}, gate={"shutter": "closed"})
    assert dose.powers(SETUP, closed) == {"holder": 0.0}
    gone = observed(laser=ON | {"power": 2.0}, without=("holder",))
    assert dose.powers(SETUP, gone) == {"holder": 0.0}
    assert dose.powers(SETUP, observed(laser=ON | {"power": 2.0}, without=("laser",))) == {"holder": 0.0}
    for laser, falls in (({"power": 2.0}, 0.0), (ON | {"power": 2.0}, 2.0)):
        seen = observed(laser=laser)
        beside = {"stranger": replace(seen.components["cam"], pose=carried()), **seen.components}
        assert dose.powers(SETUP, replace(seen, components=beside)) == {"holder": pytest.approx(falls)}


@pytest.mark.parametrize(("spent", "more", "over"), [
    (0.0, 10.0, False), (0.0, 10.001, True), (4.0, 6.0, False), (4.0, 6.1, True), (10.0, 0.0, False), (11.0, 0.0, True),
    (9.0, 2.0, True),
])  # fmt: skip
def test_a_budget_is_for_all_that_was_spent_and_comes(spent: float, more: float, over: bool) -> None:
    found = dose.over(one(spent), more, 2.0)
    assert [(d.severity, d.code, d.address) for d in found] == ([("error", "dose", "holder")] if over else [])
    assert dose.over(one(spent, budget=None), more, 2.0) == []
    assert not found or f"{more:.4g} mJ more, in 2 s" in found[0].summary


@pytest.mark.parametrize("before", [0.0, 1.0, 2.0])
@pytest.mark.parametrize("after", [0.0, 1.0, 2.0])
@pytest.mark.parametrize("spent", [0.0, 6.0])
@pytest.mark.parametrize("seconds", [1.5, 3.0, 4.5, 8.0])
def test_an_operation_counts_as_the_brighter_of_before_and_after(
    before: float, after: float, spent: float, seconds: float
) -> None:
    seen = observed(laser=ON | {"power": before})
    ops = timed([(power(after), 0.0, seconds)])
    found = dose.refused(SETUP, seen, [one(spent, before)], ops)
    exceeds = spent + max(before, after) * seconds > 10.0
    assert bool(found) is (exceeds and after > 0.0)
    assert not found or f"{max(before, after) * seconds:.4g} mJ more, in {seconds:g} s" in found[0].summary


def test_operations_add_up_in_the_order_of_their_starts_with_the_pauses_between_them() -> None:
    dark = observed(laser={"power": 2.0})
    found = dose.refused(SETUP, dark, [one()], timed([(ELSE, 3.0, 2.0), (OPENED, 0.0, 1.0), (ELSE, 7.0, 1.0)]))
    assert "16 mJ more, in 8 s" in found[0].summary  # opened for 1 s, then 2 mW until 8 s
    assert not dose.refused(SETUP, dark, [one()], timed([(OPENED, 0.0, 1.0), (ELSE, 1.0, 3.9)]))
    assert dose.refused(SETUP, dark, [one(0.1)], timed([(OPENED, 0.0, 1.0), (ELSE, 1.0, 4.0)]))
    together = timed([(OPENED, 0.0, 4.0), (ELSE, 1.0, 2.0), (ELSE, 1.0, 4.5)])
    assert "10 mJ more, in 5.5 s" not in str(dose.refused(SETUP, dark, [one()], together))
    assert "11 mJ more, in 5.5 s" in dose.refused(SETUP, dark, [one()], together)[0].summary


@pytest.mark.parametrize("short", [0.5, 1.0, 3.0])
def test_an_operation_that_ends_while_a_longer_one_goes_on_takes_nothing_away(short: float) -> None:
    seen = observed(laser={"power": 2.0})
    beside = timed([(OPENED, 0.0, 6.0), (ELSE, 1.0, short)])
    for order in (beside, beside[::-1]):
        assert "12 mJ more, in 6 s" in dose.refused(SETUP, seen, [one()], order)[0].summary


def test_what_only_darkens_is_never_refused_and_what_brightens_on_the_way_is() -> None:
    seen = observed(laser=ON | {"power": 2.0})
    spent = [one(9.9, dose.powers(SETUP, seen)["holder"])]
    assert not dose.refused(SETUP, seen, spent, timed([(SHUT, 0.0, 5.0)]))
    assert not dose.refused(SETUP, seen, spent, timed([(power(1.0), 0.0, 5.0), (SHUT, 5.0, 5.0)]))
    assert not dose.refused(SETUP, seen, spent, timed([(ELSE, 0.0, 5.0), (SHUT, 5.0, 5.0)])), "no brighter than now"
    assert dose.refused(SETUP, seen, spent, timed([(power(1.0), 0.0, 5.0)])), "it stays lit"
    assert dose.refused(SETUP, seen, spent, timed([(power(3.0), 0.0, 5.0), (SHUT, 5.0, 5.0)])), "brighter on the way"
    assert dose.refused(SETUP, seen, spent, timed([(ELSE, 0.0, 5.0)]))
    assert not dose.refused(SETUP, seen, spent, [])
    dark = observed(laser={"power": 2.0})
    by_hand = replace(OPENED, primitive="operator")
    assert dose.refused(SETUP, dark, [one(1.0)], timed([(by_hand, 0.0, 5.0)])), "opened by a person"
    assert not dose.refused(SETUP, dark, [one(99.0)], timed([(ELSE, 0.0, 5.0)])), "nothing falls on it"
    assert dose.refused(SETUP, dark, [one(99.0)], timed([(OPENED, 0.0, 5.0), (SHUT, 5.0, 1.0)]))


def test_each_sample_has_its_own_budget_and_one_without_has_none() -> None:
    seen = observed(laser={"power": 2.0})
    ops = timed([(OPENED, 0.0, 9.0)])
    assert dose.refused(SETUP, seen, [one(budget=None)], ops) == [] == dose.refused(SETUP, seen, [], ops)
    other = Dose(sample="W2", component="cam", spent=0.0, budget=1.0)
    both = replace(SETUP.lab.inventory["cam"], sample="W2", dose_budget=1.0)
    setup = replace(SETUP, lab=replace(SETUP.lab, inventory={**SETUP.lab.inventory, "cam": both}))
    found = dose.refused(setup, seen, [one(), other], ops)
    assert [d.address for d in found] == ["holder", "cam"]
    assert [d.address for d in dose.refused(setup, seen, [one(budget=99.0), other], ops)] == ["cam"]


@pytest.mark.parametrize(("into", "out"), list(itertools.product([False, True], repeat=2)))
def test_a_sample_that_is_carried_into_or_out_of_the_beam_is_followed(into: bool, out: bool) -> None:
    seen = observed(laser=ON | {"power": 2.0})
    aside = replace(seen, components={
        **seen.components, "holder": replace(seen.components["holder"], pose=replace(carried(), x=500.0, y=700.0))
    })  # fmt: skip
    start, power_now = (aside, 0.0) if into else (seen, 2.0)
    goal = (500.0, 700.0) if out else (500.0, 420.0)
    ops = timed([(carry("holder", *goal), 0.0, 4.0), (ELSE, 4.0, 4.0)])
    falls = 2.0 * ((0 if into and out else 4.0) + (0 if out else 4.0))
    found = dose.refused(SETUP, start, [one(5.0, power_now)], ops)
    assert bool(found) is (5.0 + falls > 10.0 and not out)
    placed = [replace(op, primitive="operator", robot=None) if op.component == "holder" else op for op in ops]
    assert bool(dose.refused(SETUP, start, [one(5.0, power_now)], placed)) is bool(found), "by hand, too"
    by_hand = Operation(id="h", primitive="park", component="holder", reason=Reason(kind="asked"), seconds=1.0)
    stranger = replace(set_to("laser", "shutter", "open"), component="nobody", seconds=9.0)
    assert not dose.refused(SETUP, aside, [one(5.0)], [by_hand, stranger])


def carried() -> Any:
    return observed().components["holder"].pose


PLATE = replace(
    load_catalog()["plate_beam_splitter"], name="plate",
    parameters={"reflectance": Parameter(value=0.9), "transmittance": Parameter(value=0.1),
                "thickness": Parameter(value=3.0, unit="mm")},
)  # fmt: skip


def resonant(budget: float | None = 10.0) -> tuple[Setup, Any]:
    """The bench with two plates that face each other before and behind the sample: light goes to and fro there."""
    setup = held(budget)
    at = setup.lab.inventory
    plates = {"c1": Pose(400, 420), "c2": Pose(640, 420, 180)}
    setup = replace(
        setup, catalog={**setup.catalog, "plate": PLATE},
        lab=replace(setup.lab, inventory={**at, **{n: Part(type="plate", pose=p) for n, p in plates.items()}}),
    )  # fmt: skip
    return setup, plates


@pytest.mark.parametrize("open", [True, False])
def test_light_that_was_not_followed_to_its_end_may_be_too_much(open: bool) -> None:
    setup, plates = resonant()
    seen = observed(laser=(ON if open else {}) | {"power": 2.0})
    parts = {n: ObservedComponent(pose=p) for n, p in plates.items()}
    seen = replace(seen, components={**seen.components, **parts})
    _, beyond = dose.falling(setup, seen)
    assert ("followed for 256 stretches" in beyond.get("holder", "")) is open
    now = replace(one(), unknown=beyond.get("holder"))
    lit = dose.refused(setup, seen, [now], timed([(OPENED, 0.0, 1e-6)]))
    assert "how much more this would give it is unknown: the beam of laser was followed for 256" in lit[0].summary
    assert not dose.refused(setup, seen, [now], timed([(SHUT, 0.0, 5.0)])), "what darkens is never refused"
    assert not dose.refused(setup, seen, [replace(now, budget=None)], timed([(OPENED, 0.0, 1.0)]))
    ledger = Ledger(at=0.0).until(setup, seen)
    assert (ledger.least == {"W1"}) is open and all(map(math.isfinite, ledger.spent.values()))
    (told,) = ledger.doses(setup)
    assert bool(told.unknown) is bool(told.at_least) is open
    after = replace(ledger, power={}).until(setup, replace(observed(), time=10.0))
    assert (after.doses(setup)[0].at_least or False) is open, "what it had stays without a bound"
