"""What judges kills on the network finds what is wrong in planted histories, and nothing in a right one."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "benchmarks"))

import network_judged as judged  # noqa: E402

from pico.manifest.load import load_folder  # noqa: E402
from pico.model.operation import Operation, Reason  # noqa: E402
from pico.model.setup import Setup  # noqa: E402

MOVE = Operation(
    id="op1", primitive="move", component="p1", robot="arm1", reason=Reason(kind="asked"),
    arguments={"from": {"pose": {"x": 110.0, "y": 220.0, "yaw": 0.0}},
               "to": {"pose": {"x": 290.0, "y": 420.0, "yaw": 0.0}}},
)  # fmt: skip
TURN = Operation(id="op2", primitive="set", component="p2", reason=Reason(kind="asked"), arguments={"tunable": "angle"})
BEGUN = [
    judged.Doing("r/op1/1", MOVE, 7, 100.0, 130.0, False),
    judged.Doing("r/op2/1", TURN, 7, 101.0, 102.0, False),
]
EXPIRIES = {7: 120.0}
TAKEN: dict[str, Any] = {
    "fingers": "arm1", "takes": "p1", "drops": None, "toppled": False, "pose": {"x": 110.0, "y": 220.0, "yaw": 0.0},
    "at": 105.0,
}  # fmt: skip
LET_GO = {**TAKEN, "takes": None, "drops": "p1", "at": 125.0}
LOG: list[dict[str, Any]] = [
    {"moves": "arm1", "since": 102.0, "until": 104.0}, TAKEN, {"moves": "p2.angle", "since": 101.2, "until": 101.4},
    {"moves": "arm1", "since": 119.0, "until": 129.0}, LET_GO, {"moves": "laser.shutter=closed", "since": 140.0,
                                                               "until": 140.0},
]  # fmt: skip


@pytest.fixture(scope="module")
def setup() -> Setup:
    found, _ = load_folder(ROOT / "labs" / "shel").require()
    return found


def found(log: list[dict[str, Any]], setup: Setup, begun: list[judged.Doing] = BEGUN) -> set[str]:
    """The rules that a history goes against."""
    told = {
        "late": judged.late(log, begun, EXPIRIES, []), "unjournaled": judged.unjournaled(log, begun),
        "repeated": judged.repeated(setup, log, begun), "dropped": judged.dropped(log),
    }  # fmt: skip
    return {rule for rule, wrong in told.items() if list(wrong)}


def test_nothing_is_wrong_with_what_came_to_its_safe_end(setup: Setup) -> None:
    assert found(LOG, setup) == set() and judged.overtaken(BEGUN, EXPIRIES) == 1


@pytest.mark.parametrize(
    ("more", "rule"),
    [
        ({**TAKEN, "at": 121.0}, "late"),
        ({**TAKEN, "at": 95.0}, "repeated"),
        ({**TAKEN, "pose": {"x": 290.0, "y": 420.0, "yaw": 0.0}, "at": 104.0}, "repeated"),
        ({**LET_GO, "toppled": True}, "dropped"),
        ({"moves": "arm1", "since": 90.0, "until": 91.0}, "unjournaled"),
        ({"moves": "arm1", "since": 128.0, "until": 133.0}, "unjournaled"),
        ({"moves": "arm1", "since": 128.0, "until": 150.0}, "late"),
        ({"moves": "p2.angle", "since": 110.0, "until": 110.1}, "unjournaled"),
        ({"moves": "lx_100.angle", "since": 101.2, "until": 101.3}, "unjournaled"),
        ({"moves": "laser.shutter=open", "since": 101.2, "until": 101.2}, "unjournaled"),
    ],
)
def test_what_is_wrong_is_found(setup: Setup, more: dict[str, Any], rule: str) -> None:
    log = sorted([*LOG, more], key=lambda said: said.get("at", said.get("since")))
    assert rule in found(log, setup)


def test_an_axis_that_begins_to_turn_after_its_lease_and_an_operation_that_begins_then_are_late(setup: Setup) -> None:
    turning = replace(BEGUN[1], until=122.0)
    late = [*LOG, {"moves": "p2.angle", "since": 121.0, "until": 121.1}]
    assert found(late, setup, [BEGUN[0], turning]) == {"late"}
    assert found(LOG, setup, [*BEGUN, replace(BEGUN[1], key="r/op3/1", since=120.1, until=121.0)]) == {"late"}
    assert found(LOG, setup, [*BEGUN, replace(BEGUN[1], key="r/op3/1", since=120.1, own=True)]) == set()


def test_a_part_may_be_set_right_twice_and_not_more(setup: Setup) -> None:
    again = [{**TAKEN, "at": 106.0 + n} for n in range(3)]
    assert found([*LOG, *again[:2]], setup) == set() and found([*LOG, *again], setup) == {"repeated"}


def test_what_began_lasts_until_its_end_or_the_death_of_its_edge() -> None:
    from pico.model.record import as_json
    from pico.runs.journal import JournalRecord

    def record(kind: Any, at: str, data: Any = None) -> JournalRecord:
        when = f"2026-11-26T09:00:{at}Z"
        return JournalRecord(
            seq=1, key="r/op1/1", kind=kind, component="p1", digest="", token=7, at=when, data=data or {}
        )  # fmt: skip

    records = [record("intent", "00.000", json.loads(json.dumps(as_json(MOVE)))), record("started", "01.000")]
    (one,) = judged.doings(records, {"r": "pico apply"}, [])
    assert one.until == float("inf") and not one.own
    dies = judged.Fault("edge", "killed", one.since + 3.0, one.since + 4.0)
    assert judged.doings(records, {"r": "the edge"}, [dies])[0].until == one.since + 3.0
    ended = judged.doings([*records, record("done", "02.500")], {"r": "the edge"}, [dies])[0]
    assert ended.until == one.since + 1.5 and ended.own
