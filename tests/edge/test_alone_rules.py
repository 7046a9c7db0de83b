"""A run where nobody is there, by its terms: when it is over, what is shut and put out then, and what is kept of it."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Awaitable, Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from bench_at import bench_at
from laser_lab import UNKNOWN, bench, observed, with_type

from pico.diagnostics import ExitCode, PicoError, error
from pico.edge import terms_store, unattended
from pico.edge.protocol import RECIPE
from pico.edge.terms_store import alive, read
from pico.edge.unattended import GRACE, KILLED, SILENCE, Alone
from pico.model.catalog import Tunable
from pico.model.observation import Observation, ObservedRobot
from pico.model.operation import Operation
from pico.model.setup import Setup
from pico.model.trace.unattended import Left, Terms

NAME = "night@20261124T230000Z-abcdef"
NOW, UNTIL = "2026-11-24T23:00:00Z", "2026-11-25T06:00:00Z"
LIT = {"emission": True, "shutter": "open", "power": 4.0}
PARKED = bench().lab.robots["arm1"].park_joints


def lamps() -> Setup:
    """The bench with a lamp on its holder and its camera."""
    setup = bench()
    for part in ("holder", "cam"):
        kinds = {**setup.type_of(part).tunables, "illumination": Tunable(datatype="bool", mover="electronics")}
        setup = with_type(setup, part, tunables=kinds)
    return setup


SETUP = lamps()


def terms(**more: Any) -> Terms:
    return Terms(**{"recipe": NAME, "laser_class": "3R", "until": UNTIL, "every": 600.0, **more})


class Edge:
    """An edge that notes what it is asked for; who takes it shuts what is due, as the real one does."""

    def __init__(self, root: Path, **values: Any) -> None:
        self.setup, self.place, self.time, self.moves = SETUP, bench_at(root), NOW, False
        self.values, self.joints, self.holding = values, PARKED, None
        self.said, self.fails, self.stuck = list[str](), "", False
        self.started, self.jams = list[Any](), False
        self.alone: Alone | None = None

    async def describe(self) -> Any:
        return SimpleNamespace(name="sim", fidelity="kinematic")

    async def observe(self) -> Observation:
        seen = observed(**self.values)
        arm = ObservedRobot(joints=self.joints, holding=self.holding)
        return replace(seen, robots={"arm1": arm})

    async def acquire(self, holder: str, wait: float = 0.0) -> Any:
        self.said.append(f"acquire {holder} {wait:g}")
        if self.fails == "acquire":
            raise PicoError(error("locked", "somebody has it", hint="wait"))
        if self.alone is not None and not self.stuck:
            done = tuple(self.alone.tidies(SETUP, await self.observe()))
            for op in done:
                own = {**self.values.get(op.component, {}), str(op.arguments["tunable"]): op.arguments["to"]}
                self.values[op.component] = own
            self.alone.tidied(done)
        return "lease"

    async def release(self, lease: Any) -> None:
        self.said.append("release")

    async def start(self, job: Any, run: str) -> str:
        self.said.append(f"start {job.holder} {job.wait:g} {[op.primitive for op in job.plan.operations]}")
        self.started.append(job)
        if not self.jams:
            self.joints = PARKED
        return run

    async def report(self, run: str) -> Any:
        self.said.append("report")

    async def end_of(self, holder: str) -> None:
        self.said.append(f"end of {holder}")

    def now(self) -> str:
        return self.time

    def moving(self) -> bool:
        return self.moves


def held(edge: Edge, go: Callable[[Alone], Awaitable[Any]], **more: Any) -> Any:
    """Hold a run on an edge, and do something with what holds it."""

    async def all_() -> Any:
        alone = edge.alone = Alone(edge)  # type: ignore[arg-type]
        await alone.hold(terms(**more))
        try:
            return await go(alone)
        finally:
            alone._drop()

    return asyncio.run(all_())


# when it is over


def test_the_times_of_an_unattended_run_are_kept() -> None:
    assert (SILENCE, GRACE, unattended.LOOKS) == (660.0, 60.0, 0.2)


@pytest.mark.parametrize("every", [0.0, 10.0, 600.0, 660.0, 661.0, 3600.0])
@pytest.mark.parametrize("quiet", [0.0, 300.0, 700.0, 720.0, 721.0, 1000.0, 3660.0, 3661.0])
@pytest.mark.parametrize("moving", [True, False])
def test_a_client_has_so_long_to_say_that_it_goes_on_as_its_terms_leave_it_and_eleven_minutes_at_least(
    tmp_path: Path, every: float, quiet: float, moving: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    edge, clock = Edge(tmp_path), [1000.0]
    edge.moves = moving
    monkeypatch.setattr(unattended, "time", SimpleNamespace(monotonic=lambda: clock[0]))

    async def go(alone: Alone) -> str:
        clock[0] += quiet
        return alone._over(terms(every=every))

    why = held(edge, go, every=every)
    silent = not moving and quiet > max(every, 660.0) + 60.0
    assert why == (f"its client said nothing for {quiet:.0f} s" if silent else "")


@pytest.mark.parametrize(("now", "over"), [
    ("2026-11-25T05:59:59Z", False), (UNTIL, True), ("2026-11-25T06:00:01Z", True), ("2026-11-25T07:30:00+02:00", False)
])  # fmt: skip
@pytest.mark.parametrize("moving", [True, False])
def test_a_run_is_over_at_its_end_whether_something_moves_or_not(
    tmp_path: Path, now: str, over: bool, moving: bool
) -> None:
    edge = Edge(tmp_path)
    edge.time, edge.moves = now, moving

    async def go(alone: Alone) -> str:
        return alone._over(terms())

    assert held(edge, go) == (f"it was to end at {UNTIL}" if over else "")


def test_what_moves_or_says_so_goes_on(tmp_path: Path) -> None:
    edge = Edge(tmp_path)

    async def go(alone: Alone) -> None:
        for hear in (lambda: alone.goes_on(NAME), lambda: setattr(edge, "moves", True)):
            alone._heard = time.monotonic() - 5000.0
            hear()
            assert alone._over(terms()) == "" and time.monotonic() - alone._heard < 100
        edge.moves, alone._heard = False, time.monotonic() - 5000.0
        alone.goes_on("other@x")
        assert alone._over(terms()) != "", "another run says nothing of this one"

    held(edge, go)


def test_the_edge_ends_a_run_that_is_over_by_itself_and_tells_its_client(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(unattended, "LOOKS", 0.0)
    edge = Edge(tmp_path, laser=LIT)

    async def go(alone: Alone) -> None:
        for _ in range(20):
            await asyncio.sleep(0)
        assert alone.most() == "3R" and alone.terms is not None and alone.terms.left is None
        edge.time = UNTIL
        for _ in range(10_000):
            if alone.terms is None or alone.terms.left is not None:
                break
            await asyncio.sleep(0)
        assert alone.terms is not None and alone.terms.left is not None
        assert alone.terms.left.why == f"it was to end at {UNTIL}" and alone.most() is None
        with pytest.raises(PicoError, match="the edge ended the run") as caught:
            alone.goes_on(NAME)
        assert caught.value.exit_code == ExitCode.INTERRUPTED
        alone.goes_on("other@x")
        assert await alone.leave(NAME, moves=True) == alone_left
        assert read(bench_at(tmp_path)) is not None

    alone_left = Left(why=f"it was to end at {UNTIL}", reached=("shut", "lamps off", "parked"),
                      was={"laser.shutter": "open"})  # fmt: skip
    edge.values |= {"holder": {"illumination": False}, "cam": {"illumination": False}}
    edge.joints = (PARKED[0] + 0.2, *PARKED[1:])
    held(edge, go)
    assert len(edge.started) == 1, "an arm that was under way is parked, too"


def test_a_run_that_its_client_leaves_just_now_is_not_ended_once_more(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(unattended, "LOOKS", 0.0)
    edge = Edge(tmp_path, laser=LIT)

    async def go(alone: Alone) -> None:
        watching = alone._watching
        assert watching is not None
        async with alone._ending:
            edge.time = UNTIL
            for _ in range(10):
                await asyncio.sleep(0)  # it waits for its turn to end the run
            alone.terms = None
        for _ in range(10):
            await asyncio.sleep(0)
        assert watching.done() and watching.exception() is None and edge.said == []

    held(edge, go)


# how the bench is left


@pytest.mark.parametrize("end", [(), ("shut",), ("lamps off",), ("parked",), ("shut", "parked", "lamps off")])
@pytest.mark.parametrize("stuck", [True, False])
@pytest.mark.parametrize("away", [True, False])
def test_a_bench_is_left_as_the_terms_state_and_what_is_not_reached_is_told(
    tmp_path: Path, end: tuple[str, ...], stuck: bool, away: bool
) -> None:
    edge = Edge(tmp_path, laser=LIT, holder={"illumination": True}, cam={"illumination": False})
    edge.stuck = stuck
    edge.joints = tuple(q + 0.5 for q in PARKED) if away else PARKED

    async def go(alone: Alone) -> Left:
        return await alone.leave(NAME, moves=False)

    left = held(edge, go, end=end)
    good = {"shut": not stuck, "lamps off": not stuck, "parked": not away}
    assert left.reached == tuple(e for e in ("shut", "lamps off", "parked") if e in end and good[e])
    assert len(left.wrong) == sum(e in end and not good[e] for e in good) and left.why == ""
    changed = not stuck and {"laser.shutter": "open"} if "shut" in end else {}
    lit = {"holder.illumination": True} if "lamps off" in end and not stuck else {}
    assert left.was == {**(changed or {}), **lit}
    assert edge.said == [f"end of {RECIPE} {NAME}", f"acquire the end of {NAME} 60", "release"]
    texts = " ".join(d.summary for d in left.wrong)
    assert ("laser may emit still" in texts) is ("shut" in end and stuck)
    assert ("holder may be lit still" in texts) is ("lamps off" in end and stuck)
    assert ("arm1 stands where it stopped" in texts) is ("parked" in end and away)


@pytest.mark.parametrize("how", ["leave", "leave, nothing moves", "gone", "close"])
@pytest.mark.parametrize("jams", [True, False])
@pytest.mark.parametrize("end", [("parked",), ("shut",)])
def test_arms_are_parked_at_the_end_unless_nothing_moves_any_more(
    tmp_path: Path, how: str, jams: bool, end: tuple[str, ...]
) -> None:
    edge = Edge(tmp_path)
    edge.joints, edge.jams = (PARKED[0] + 0.2, *PARKED[1:]), jams

    async def go(alone: Alone) -> None:
        watching = alone._watching
        await asyncio.sleep(0)  # it looks
        if how.startswith("leave"):
            await alone.leave(NAME, moves=how == "leave")
        else:
            await (alone.gone(NAME) if how == "gone" else alone.close())
        for _ in range(3):
            await asyncio.sleep(0)
        assert watching is not None and watching.done(), "nobody looks after it any more"

    held(edge, go, end=end)
    parks = how in ("leave", "gone") and end == ("parked",)
    assert edge.said[3:] == (["start the edge 60 ['park']", "report"] if parks else [])
    if parks:
        (job,) = edge.started
        assert job.plan.target.recipe == NAME and job.plan.target.step == "unattended"
    left = read(bench_at(tmp_path))
    if left is not None and left.left is not None and end == ("parked",):
        assert left.left.reached == (("parked",) if parks and not jams else ())
        assert bool(left.left.wrong) is not (parks and not jams)


def test_an_arm_that_holds_something_is_not_parked(tmp_path: Path) -> None:
    edge = Edge(tmp_path)
    edge.holding = "holder"  # type: ignore[assignment]

    async def go(alone: Alone) -> Left:
        return await alone.leave(NAME, moves=False)

    left = held(edge, go, end=("parked",))
    assert left.reached == () and "arm1 stands where it stopped and holds holder" in left.wrong[0].summary


def test_a_bench_that_cannot_be_had_is_told_as_not_left_so(tmp_path: Path) -> None:
    edge = Edge(tmp_path, laser=LIT)
    edge.fails = "acquire"

    async def go(alone: Alone) -> Left:
        return await alone.leave(NAME, moves=True)

    left = held(edge, go)
    assert left.reached == () and left.wrong[0].summary == "the bench is not left as night states: somebody has it"
    assert left.wrong[0].hint == "wait"


@pytest.mark.parametrize("moves", [True, False])
@pytest.mark.parametrize("ended", ["", "gone", "close"])
def test_what_is_kept_of_a_run_after_its_end(tmp_path: Path, moves: bool, ended: str) -> None:
    edge = Edge(tmp_path, laser=LIT)

    async def go(alone: Alone) -> None:
        assert alive(bench_at(tmp_path)) and read(bench_at(tmp_path)) == terms() and alone.known() == terms()
        await alone.gone("other@x")
        assert alone.terms is not None and await alone.leave("other@x", moves=True) == Left()
        if ended == "gone":
            await alone.gone(NAME)
        elif ended == "close":
            await alone.close()
        else:
            await alone.leave(NAME, moves=moves)
        assert alone.terms is None and not alive(bench_at(tmp_path)) and alone.most() is None
        assert await alone.leave(NAME, moves=True) == Left(), "it is left already"

    held(edge, go)
    kept = read(bench_at(tmp_path))
    if ended == "" and moves:
        assert kept is None, "its client left it as it states, and it will not go on"
    else:
        assert kept is not None and kept.left is not None
        assert kept.left.why == {"": "", "gone": unattended.GONE, "close": "the process of the bench ended"}[ended]
    assert edge.values["laser"]["shutter"] == "closed"


# what is due


@pytest.mark.parametrize("end", [("shut",), ("lamps off",), ("shut", "lamps off"), ("parked",)])
@pytest.mark.parametrize("who", ["killed", "left", "alive", "nobody"])
def test_what_a_run_left_undone_whose_process_died_is_due_to_whoever_comes_next(
    tmp_path: Path, end: tuple[str, ...], who: str
) -> None:
    if who != "nobody":
        terms_store.write(bench_at(tmp_path), terms(end=end, left=Left(why="x") if who == "left" else None))
    lock = terms_store.lock(bench_at(tmp_path)) if who == "alive" else None
    edge = Edge(tmp_path, laser=LIT, second={"shutter": "open"}, bare={"emission": True}, holder={"illumination": True})
    alone = Alone(edge)  # type: ignore[arg-type]
    due = tuple(alone.tidies(SETUP, asyncio.run(edge.observe())))
    wanted = ["laser.shutter", "bare.emission", "second.shutter"] if "shut" in end else []
    wanted += ["holder.illumination", "cam.illumination"] if "lamps off" in end else []
    assert sorted(op.address for op in due) == (sorted(wanted) if who == "killed" else [])
    assert alone.due() is (who == "killed") and alive(bench_at(tmp_path)) is (who == "alive")
    for op in due:
        assert op.arguments["to"] in ("closed", False) and op.reason.kind == "interlock"
        assert op.reason.text == "the unattended run night is over"
        said = alone.told(op)
        assert (said.severity, said.address) == ("warning", op.component)
        assert f"{op.address} was set to {op.arguments['to']}" in said.summary
    known = alone.known()
    if who == "killed":
        assert known is not None and known.left is not None and known.left.why == KILLED
        assert f"the bench is not left {', '.join(end)} yet" in known.left.wrong[0].summary
        alone.tidied(due)
        after = read(bench_at(tmp_path))
        assert after is not None and after.left is not None and not alone.due()
        assert after.left.reached == tuple(e for e in end if e != "parked") and after.left.why == KILLED
        assert after.left.was == {op.address: op.arguments["from"] for op in due if op.arguments["from"] is not None}
    else:
        assert known == read(bench_at(tmp_path))
    if lock is not None:
        import os

        os.close(lock)


@pytest.mark.parametrize(("lamp", "out"), [(True, True), (False, False), (UNKNOWN, True), (None, True)])
def test_lamps_are_put_out_unless_they_are_known_to_be(tmp_path: Path, lamp: Any, out: bool) -> None:
    seen = observed(holder={"illumination": lamp}, cam={"illumination": False})
    found = list(unattended._dark(SETUP, seen, "w"))
    assert [op.address for op in found] == (["holder.illumination"] if out else [])
    assert all(op.primitive == "set" and op.arguments["to"] is False for op in found)
    assert all(op.resources == ("holder.illumination", "holder") and op.reason.text == "w" for op in found)


def test_nothing_is_due_while_a_run_is_held(tmp_path: Path) -> None:
    edge = Edge(tmp_path, laser=LIT)

    async def go(alone: Alone) -> tuple[Operation, ...]:
        assert not alone.due()
        return tuple(alone.tidies(SETUP, await edge.observe()))

    assert held(edge, go) == ()


# who holds it


def test_one_run_is_held_at_a_time_and_the_terms_of_one_that_died_are_brought_about_first(tmp_path: Path) -> None:
    edge = Edge(tmp_path, laser=LIT)

    async def go(alone: Alone) -> None:
        other = Alone(Edge(tmp_path))  # type: ignore[arg-type]
        with pytest.raises(PicoError, match=f"the unattended run {NAME} is under way") as caught:
            await other.hold(terms(recipe="other@x"))
        assert caught.value.exit_code == ExitCode.LOCKED and other.terms is None and alive(bench_at(tmp_path))

    held(edge, go)
    terms_store.write(bench_at(tmp_path), terms())
    again = Edge(tmp_path, laser=LIT)
    held(again, lambda alone: asyncio.sleep(0), recipe="other@x")
    assert again.said == ["acquire the end of an unattended run 60", "release"]
    assert again.values["laser"]["shutter"] == "closed"
    terms_store.write(bench_at(tmp_path), terms())
    same = Edge(tmp_path, laser=LIT)
    held(same, lambda alone: asyncio.sleep(0))
    assert same.said == [] and same.values["laser"] == LIT, "it goes on with what it had"


@pytest.mark.parametrize("recipe", [NAME, "other@x"])
def test_a_run_that_is_taken_up_hears_how_it_was_left(tmp_path: Path, recipe: str) -> None:
    terms_store.write(bench_at(tmp_path), terms(left=Left(why="w", reached=("shut",))))
    edge = Edge(tmp_path)

    async def go() -> Left | None:
        alone = Alone(edge)  # type: ignore[arg-type]
        found = await alone.hold(terms(recipe=recipe, left=Left(why="of before")))
        assert alone.terms is not None and alone.terms.left is None and edge.said == []
        alone._drop()
        return found

    assert asyncio.run(go()) == (Left(why="w", reached=("shut",)) if recipe == NAME else None)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"recipe": 3}', "null"])
def test_terms_that_cannot_be_read_count_as_a_killed_run_that_shuts_everything(tmp_path: Path, text: str) -> None:
    terms_store.write(bench_at(tmp_path), terms())
    path = bench_at(tmp_path).folder / "unattended.json"
    assert json.loads(path.read_text())["recipe"] == NAME and read(bench_at(tmp_path)) == terms()
    path.write_text(text)
    found = read(bench_at(tmp_path))
    assert found is not None and found.left is None and set(found.end) == {"shut", "lamps off"}
    assert str(path) in found.recipe and "damaged" in found.recipe and not alive(bench_at(tmp_path))
