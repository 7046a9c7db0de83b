"""Where the nearest slots are of no use, the others are looked at before anything is refused."""

from __future__ import annotations

import pytest
from checker import check
from planning_benches import Places, bench, planned, see, want

from pico.model.lab import Box2, KeepOut, Slot
from pico.model.plan import Staging

COVERED = {"lid": KeepOut(area=Box2(x=(0, 700), y=(0, 140)))}


@pytest.mark.parametrize(("movers", "useless"), [(2, 70), (9, 30)])
def test_a_slot_farther_away_than_many_of_no_use_breaks_a_ring(movers: int, useless: int) -> None:
    slots = {f"near{i:02}": Slot(x=100 + 5 * i, y=100) for i in range(useless)} | {"far": Slot(x=750, y=50)}
    starts: Places = {f"b{i}": (60 + 80 * i, 300) for i in range(movers)}
    goals: Places = {**{n: (p[0], 320) for n, p in starts.items()}, "b0": starts["b1"], "b1": starts["b0"]}
    setup = bench(dict.fromkeys(starts, "block"), slots, keep_out=COVERED)
    seen, wanted = see(setup, starts), want(goals)
    made = planned(setup, seen, wanted)
    assert check(setup, seen, wanted, made) == []
    assert made.staging == Staging(count=1, lower_bound=1, proven=True)


def test_it_is_no_proof_where_there_are_more_slots_than_are_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pico.planning.ordering.conflicts.EVERY_SLOT", 1)
    slots = {f"near{i:02}": Slot(x=100 + 5 * i, y=100) for i in range(70)} | {"far": Slot(x=750, y=50)}
    starts: Places = {"a": (100, 300), "b": (180, 300)}
    setup = bench(dict.fromkeys(starts, "block"), slots, keep_out=COVERED)
    made = planned(setup, see(setup, starts), want({"a": starts["b"], "b": starts["a"]}))
    assert made.errored and made.blocking is None
    assert made.diagnostics[0].detail.endswith("the search ended at its limit of storage slots")
