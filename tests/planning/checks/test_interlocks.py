"""Nobody works in an open beam, and no motor turns on a part that is carried."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from checker import check
from fuzzing import plan_case
from hypothesis import given, settings
from hypothesis import strategies as st
from planning_benches import TALL, TYPES, bench, one, part, planned, see, want
from random_labs import random_case

from examples import examples
from pico.execution.graph import Graph
from pico.model.arming import Licence
from pico.model.catalog import ComponentType, OpticalElement, Parameter, Tunable
from pico.model.lab import Policy
from pico.model.observation import Observation, ObservedRobot
from pico.model.operation import Operation
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.model.state import LabState
from pico.planning import home_one, move_one, set_values
from pico.planning.checks.emission import refused

SHUTTER = Tunable(datatype="choice", choices=("open", "closed"), settle=50)
LASER = ComponentType(
    name="laser", title="Laser", geometry=TALL, seating="bolted", optics=OpticalElement(element="source"),
    tunables={"shutter": SHUTTER, "emission": Tunable(datatype="bool", settle=5000)},
)  # fmt: skip
PLATE = replace(TYPES["block"], name="plate", optics=OpticalElement(element="waveplate"))
POLARIZER = replace(TYPES["block"], name="polarizer", optics=OpticalElement(element="polarizer"))
HERE, THERE = (300, 300), (500, 300)


def lit(lasers: int = 1, **lab: Any) -> Setup:
    """A bench with lasers, and parts that the arm moves."""
    parts = {f"laser{n}": part("laser", pose=Pose(100 + 100 * n, 420)) for n in range(lasers)}
    moved = {"a": part(home="s1"), "plate": part("plate", home="s2"), "pol": part("polarizer", home="s2")}
    setup = bench({**parts, **moved}, **lab)
    return Setup(lab=setup.lab, catalog={**TYPES, "laser": LASER, "plate": PLATE, "polarizer": POLARIZER})


Values = dict[str, dict[str, Any]]


def at(a: tuple[int, int], lasers: int = 1) -> dict[str, tuple[int, int]]:
    shutters = {f"laser{n}": (100 + 100 * n, 420) for n in range(lasers)}
    return {**shutters, "a": a, "plate": (600, 420), "pol": (700, 420)}


def case(
    shutter: str | None, goal: str | None, moves: bool = True, setup: Setup | None = None
) -> tuple[Setup, Observation, LabState]:
    """A shutter as it is seen and as it is wanted, and a part that moves or not."""
    setup = setup or lit()
    seen = see(setup, at(HERE), {"laser0": {"shutter": shutter}})
    wanted: Values = {"laser0": {"shutter": goal}} if goal else {}
    return setup, seen, want(at(THERE if moves else HERE), wanted)


def steps(made: Plan) -> list[str]:
    return [o.arguments["to"] if o.component == "laser0" else o.primitive for o in made.operations]


def beam_faults(setup: Setup, seen: Observation, made: Plan) -> list[str]:
    """Every arm's operation is after each laser's closing in every order that keeps `after`, and before its opening."""
    before = {o.id: set(o.after) for o in made.operations}
    for o in made.operations:  # sorted by start: what one comes after is complete when it is its turn
        before[o.id] |= {e for a in o.after for e in before[a]}
    faults = []
    for laser in (n for n in setup.lab.inventory if setup.type_of(n) is LASER):
        settings = [o for o in made.operations if o.component == laser and o.arguments["tunable"] == "shutter"]
        live = seen.components[laser].values["shutter"]
        for o in made.operations:
            if not o.robot:
                continue
            done = [s.arguments["to"] for s in settings if s.id in before[o.id]]
            now = done[-1] if done else live.value
            loose = [s.id for s in settings if s.id not in before[o.id] and o.id not in before[s.id]]
            if now != "closed" or loose:
                faults.append(f"{laser} is {now} at {o.id}, and {loose} may come at any time")
    return faults


def test_the_shutter_is_closed_before_the_arm_moves_and_opens_when_it_is_parked() -> None:
    setup, seen, wanted = case("open", "open")
    made = planned(setup, seen, wanted)
    assert steps(made) == ["closed", "move", "park", "open"]
    close, *_, back = made.operations
    assert (close.reason.kind, close.reason.text) == ("interlock", "arm1 works in the beam")
    assert (back.reason.kind, back.arguments["from"]) == ("interlock", "closed")
    assert [rule["text"] for rule in made.policy] == ["laser0 shutter closed during 1 move"]
    assert check(setup, seen, wanted, made) == [] == beam_faults(setup, seen, made)


@pytest.mark.parametrize(
    ("seen", "wanted", "told"),
    [
        ("closed", "closed", ["move", "park"]),
        ("closed", "open", ["move", "park", "open"]),
        ("open", "closed", ["closed", "move", "park"]),
        ("open", None, ["closed", "move", "park", "open"]),
        ("closed", None, ["move", "park"]),
        (None, "open", ["closed", "move", "park", "open"]),
        (None, "closed", ["closed", "move", "park"]),
        (None, None, ["closed", "move", "park"]),
    ],
)
def test_the_shutter_ends_as_wanted_else_as_it_was(seen: str | None, wanted: str | None, told: list[str]) -> None:
    assert steps(planned(*case(seen, wanted))) == told


def test_without_a_move_nobody_touches_the_shutter() -> None:
    made = planned(*case("open", "open", moves=False))
    assert (made.operations, made.policy) == ((), ())
    setup, seen, _ = case("open", None)
    assert [o.arguments["to"] for o in one(set_values, setup, seen, "laser0", {"shutter": "closed"}).operations] == [
        "closed"
    ]


def test_an_equal_bench_stays_equal_after_the_shutter_was_opened_again() -> None:
    assert steps(planned(*case("closed", "open", moves=False))) == ["open"]


@pytest.mark.parametrize(("live", "told"), [("closed", ["move", "park"]), ("open", ["closed", "move", "park", "open"])])
def test_in_a_plan_for_other_components_the_shutter_ends_as_it_was(live: str, told: list[str]) -> None:
    setup, seen, wanted = case(live, "open" if live == "closed" else "closed")
    assert steps(planned(setup, seen, wanted, targets=["a"])) == told


def test_a_single_move_closes_the_shutter_and_opens_it_again() -> None:
    setup, seen, _ = case("open", None)
    assert steps(one(move_one, setup, seen, "a", Pose(*THERE))) == ["closed", "move", "park", "open"]


@pytest.mark.parametrize(("name", "told"), [("plate", ["closed", "home", "open"]), ("pol", ["home"])])
def test_homing_closes_the_shutter_where_it_steers_the_beam(name: str, told: list[str]) -> None:
    setup = lit()
    seen = see(setup, at(HERE), {"laser0": {"shutter": "open"}, name: {"angle": 10.0}})
    assert steps(one(home_one, setup, seen, name, "angle")) == told


def test_where_the_lab_allows_open_beam_work_the_shutter_stays() -> None:
    setup, seen, wanted = case("open", "open", setup=lit(policy=Policy(open_beam=True)))
    made = planned(setup, seen, wanted)
    assert steps(made) == ["move", "park"]
    assert [rule["text"] for rule in made.policy] == ["open beam allowed during 1 move"]


def test_no_shutter_opens_while_a_robot_holds_something() -> None:
    setup, seen, wanted = case(shutter="closed", goal="open", moves=False)
    hand = {"arm1": ObservedRobot(joints=(), holding="a")}
    first = planned(setup, replace(seen, robots=hand), wanted)
    assert steps(first)[0] == "stow" and steps(first)[-1] == "open"  # it is set down before the shutter opens
    hidden = {**seen.components, "a": replace(seen.components["a"], presence="held", pose=None)}
    made = planned(setup, replace(seen, robots=hand, components=hidden), wanted)
    assert made.errored
    assert [d.summary for d in made.diagnostics if d.code == "hand-full"]
    assert not planned(setup, seen, wanted).errored


def test_a_shutter_that_is_to_be_closed_closes_before_a_hand_sets_down_what_it_holds() -> None:
    setup, seen, wanted = case("open", "closed", moves=False)
    parts = {**seen.components, "a": replace(seen.components["a"], presence="held")}
    hand = {"arm1": ObservedRobot(joints=(), holding="a", picked=Pose(*HERE))}
    made = planned(setup, replace(seen, components=parts, robots=hand), wanted)
    assert steps(made) == ["closed", "move", "park"]
    assert made.operations[1].after == (made.operations[0].id,)


def test_a_laser_that_nothing_can_close_is_told() -> None:
    setup, seen, wanted = case("open", "open")
    by_hand = replace(LASER, tunables={"shutter": replace(SHUTTER, mover="person")})
    setup = Setup(lab=setup.lab, catalog={**setup.catalog, "laser": by_hand})
    made = planned(setup, seen, wanted)
    assert [d.code for d in made.diagnostics] == ["open-beam"]
    assert steps(made) == ["move", "park"]


def test_the_shutter_is_closed_while_a_person_works_at_the_table() -> None:
    setup = lit()
    seen = see(setup, at(HERE), {"laser0": {"shutter": "open"}, "a": {"filter": "red"}})
    close, by_hand, back = one(set_values, setup, seen, "a", {"filter": "blue"}).operations
    assert (close.arguments["to"], by_hand.primitive, back.arguments["to"]) == ("closed", "operator", "open")
    assert close.reason.text == "a person works in the beam"
    assert close.id in by_hand.after and by_hand.id in back.after


def gated(gate: tuple[float, ...], *more: tuple[float, float]) -> tuple[Setup, Observation]:
    """A laser without a shutter at (100, 420) that shines along x, and a shutter on the table."""
    setup = lit()
    optics, wide = OpticalElement(element="shutter"), {"clear_diameter": Parameter(value=12.7, unit="mm")}
    shutter = {"shutter": SHUTTER}
    kinds = {
        "laser": replace(LASER, tunables={}),
        "gate": replace(TYPES["block"], name="gate", optics=optics, parameters=wide, tunables=shutter),
    }
    others = {f"m{n}": where for n, where in enumerate(more)}
    parts = {"gate": part("gate", home="s1")} | {name: part(home="s2") for name in others}
    lab = replace(setup.lab, inventory={**setup.lab.inventory, **parts})
    setup = Setup(lab=lab, catalog={**setup.catalog, **kinds})
    places = {"laser0": (100, 420), "a": HERE, "gate": gate, **others}
    return setup, see(setup, places, {"gate": {"shutter": "open"}})


def moved_beside(setup: Setup, seen: Observation, to: Pose = Pose(*THERE)) -> Plan:  # noqa: B008
    return one(move_one, setup, seen, "a", to)


def test_a_shutter_that_stands_in_the_beam_closes_it() -> None:
    made = moved_beside(*gated((300, 421, 180)))
    assert [(o.component, o.arguments.get("to")) for o in made.operations if o.primitive == "set"] == [
        ("gate", "closed"), ("gate", "open"),
    ]  # fmt: skip
    assert not made.diagnostics
    assert [rule["text"] for rule in made.policy] == ["gate shutter closed during 1 move"]


@pytest.mark.parametrize(
    ("gate", "more", "to"),
    [
        ((300, 440, 0), [], THERE),  # beside the beam
        ((300, 420, 90), [], THERE),  # along it
        ((50, 420, 0), [], THERE),  # behind the laser
        ((300, 420, 0), [(200, 420)], THERE),  # something before it sends the beam elsewhere
        ((300, 420, 0), [], (200, 420)),  # something is put down before it
    ],
)
def test_a_shutter_elsewhere_does_not_count(gate: Any, more: Any, to: Any) -> None:
    made = moved_beside(*gated(gate, *more), to=Pose(*to))
    assert [o.primitive for o in made.operations] == ["move", "park"]
    assert [d.code for d in made.diagnostics] == ["open-beam"]


def test_a_shutter_that_is_moved_does_not_count() -> None:
    setup, seen = gated((300, 420, 0))
    made = one(move_one, setup, seen, "gate", Pose(400, 420))
    assert [d.code for d in made.diagnostics] == ["open-beam"]


def test_a_shutter_that_is_all_that_closes_an_unarmed_laser_is_not_moved_out_of_its_beam() -> None:
    setup, seen = gated((300, 420, 0))
    strong = {"power": Parameter(value=500, unit="mW"), "wavelength": Parameter(value=800, unit="nm")}
    kinds = {**setup.catalog, "laser": replace(setup.catalog["laser"], parameters=strong)}
    for enclosed in (None, True):
        lab = replace(setup.lab, policy=replace(setup.lab.policy, enclosed=enclosed))
        unarmed = Setup(lab=lab, catalog=kinds)
        made = one(move_one, unarmed, seen, "gate", Pose(400, 200))
        assert "unarmed" in [d.code for d in made.diagnostics if d.severity == "error"]
        assert "nobody has armed it" in refused(unarmed, seen, made.operations)[0].summary
    armed = replace(seen, licences={"laser0": Licence(laser_class="3B", by="Ann", ends="2027-01-01T00:00:00Z")})
    assert not refused(Setup(lab=setup.lab, catalog=kinds), armed, made.operations)


def run(made: Plan, fails: str) -> dict[str, str]:
    """What becomes of each operation where one fails, as the walk has it."""
    graph = Graph(made.operations)
    while ready := graph.ready():
        for op in ready:
            graph.start(op)
        for op in ready:
            graph.finish(op, "failed" if op.id == fails else "done")
    return dict(graph.status)


def test_after_a_failed_move_the_arm_parks_and_the_shutter_stays_closed() -> None:
    setup = lit()
    seen = see(setup, at(HERE), {"laser0": {"shutter": "open"}})
    made = planned(setup, seen, want({**at(THERE), "pol": (700, 300)}))
    moves = [o.id for o in made.operations if o.primitive == "move"]
    assert len(moves) == 2
    for lost in moves:
        became = run(made, lost)
        kinds = {o.primitive if o.robot else o.arguments["to"]: became[o.id] for o in made.operations}
        assert (kinds["closed"], kinds["park"], kinds["open"]) == ("done", "done", "skipped")


def test_where_the_shutter_fails_nothing_is_picked() -> None:
    made = planned(*case("open", "open"))
    became = run(made, made.operations[0].id)
    assert [became[o.id] for o in made.operations] == ["failed", "skipped", "done", "skipped"]


SHUTTERS = st.sampled_from(("open", "closed", None))


@settings(max_examples=examples(60), deadline=None)
@given(
    live=st.tuples(SHUTTERS, SHUTTERS), goal=st.tuples(SHUTTERS, SHUTTERS), spots=st.permutations(range(3)),
    unknown=st.booleans(), emission=st.booleans(), arms=st.integers(1, 2),
)  # fmt: skip
def test_no_arm_moves_in_an_open_beam(
    live: tuple[str | None, ...], goal: tuple[str | None, ...], spots: list[int], unknown: bool, emission: bool,
    arms: int,
) -> None:  # fmt: skip
    robots = {f"arm{n}": Robot(mount=Mount(x=200 * n, y=500)) for n in range(1, arms + 1)}
    setup = lit(2, robots=robots)
    places = [(300, 300), (400, 300), (500, 300)]
    angles: Values = {n: {"angle": None if unknown else 0.0} for n in ("a", "plate")}
    seen = see(
        setup, {**at(HERE, 2), "a": places[0], "plate": places[1], "pol": places[2]},
        {f"laser{n}": {"shutter": s, "emission": False} for n, s in enumerate(live)} | angles,
    )  # fmt: skip
    lasers: Values = {f"laser{n}": {"shutter": s} if s else {} for n, s in enumerate(goal)}
    lasers["laser0"]["emission"] = emission
    wanted = want(
        {**at(HERE, 2), "a": places[spots[0]], "plate": places[spots[1]], "pol": places[spots[2]]},
        {**lasers, "plate": {"angle": 90.0}},
    )
    made = planned(setup, seen, wanted)
    assert not made.errored
    assert check(setup, seen, wanted, made) == [] == beam_faults(setup, seen, made)


@pytest.mark.parametrize("seeds", [15, pytest.param(40, marks=pytest.mark.slow)])
def test_no_motor_turns_on_a_part_that_is_carried(seeds: int) -> None:
    beside = 0
    for seed in range(seeds):
        made = plan_case(random_case(seed, most=16))
        carried = [o for o in made.operations if o.primitive in ("move", "stow", "operator")]
        driven = [o for o in made.operations if o.primitive in ("set", "home")]
        for move in carried:
            for turn in driven:
                if turn.component == move.component:
                    assert not at_once(move, turn), (seed, move.id, turn.id)
                    assert set(move.resources) & set(turn.resources), (seed, move.id, turn.id)
                beside += at_once(move, turn)
    assert beside > seeds, "nothing turns while arms move, so this shows nothing"


def at_once(a: Operation, b: Operation) -> bool:
    return a.start < b.start + b.seconds - 1e-6 and b.start < a.start + a.seconds - 1e-6


def test_a_beam_that_nothing_closes_is_warned_of_only_where_it_must_be_closed() -> None:
    for policy, codes in ((Policy(), ["open-beam"]), (Policy(open_beam=True), [])):
        setup = lit(policy=policy)
        made = planned(setup, see(setup, at(HERE)), want(at(THERE)))
        assert [d.code for d in made.diagnostics] == codes
        assert {o.primitive for o in made.operations} == {"move", "park"}
    away = {name: place for name, place in at(HERE).items() if name != "laser0"}
    assert planned(lit(), see(lit(), away), want({**away, "a": THERE})).diagnostics == ()
