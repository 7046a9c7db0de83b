"""Restorations of an emulated bench while its wires fail: `python benchmarks/wire_faults.py [--operations 1000]`.

A bench with a device of every kind (an arm over TCP, mounts on a serial line, stages, cameras, a box of switches) at
ten times real pace is brought from state to state of the example `shel`, some set-points drawn anew each time. At
random instants a wire drops, delays, doubles, cuts or garbles replies, falls silent, or what is at its end is killed
and comes back; an arm collides; a run is stopped. What fails is gone on with as a person would: `pico resume`,
`pico recover` or `pico apply`. `--seed N` draws other ones, `--quiet` lets nothing go wrong.

Judged is the journal against what the world behind the emulators went through: a component taken that stood where it
was to go, a device told to move twice for one operation or for none; an operation that began and has no end; a
component that is not where the journal or the next look says, or lies; a failure that names neither component nor
device; a call that took over 5 s; motion after a stop; a goal that five commands without faults do not reach. The exit
code is 1 where anything is wrong.

`--restoration` is one of the paper's instead, E3-2 to E1-1, without faults and at the pace of a real arm, judged in the
same way: it takes as long as that would, and has the simulator's operations.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from random import Random
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks"), str(ROOT / "tests" / "drivers")]
os.environ.setdefault("PICO_EMULATED_PACE", "10")

import wire_judged as judged  # noqa: E402
from proxy import FAULTS  # noqa: E402
from wire_told import Lateness, Log, Wires, journalled  # noqa: E402

from pico.bench.bench import Bench  # noqa: E402
from pico.diagnostics import ExitCode, PicoError  # noqa: E402
from pico.drivers.bus import LONGEST, Bus  # noqa: E402
from pico.history.examples.example import make_example  # noqa: E402
from pico.model.observation import Observation  # noqa: E402
from pico.model.operation import Operation  # noqa: E402
from pico.model.plan import Plan, Target  # noqa: E402
from pico.model.state import with_values  # noqa: E402
from pico.optics.audit.findings import AUDIT  # noqa: E402
from pico.planning import PlanGoal  # noqa: E402

STATES = ("C1", "C2", "C3", "E1-1", "E1-2", "E1-3", "E2-1", "E2-2", "E2-3", "E3-1", "E3-2")
AXES = {"hwp.angle": (0, 180), "p1.angle": (0, 180), "p2.angle": (0, 180), "ly_150.stage_y": (-1.5, 1.5),
        "ly_150.stage_z": (-1.5, 1.5), "ly_200.stage_y": (-1.5, 1.5), "ly_200.stage_z": (-1.5, 1.5)}  # fmt: skip
STAGES = """\
  ly_200_{axis}:
    driver: zaber.stage
    of: ly_200
    address: {{host: 192.0.2.30, port: 55550, device: {number}}}
    identity: {{serial: "5300{number}"}}
    settings: {{counts_per_unit: 20997.375, emulated_speed: 60}}
    map: {{stage_{axis}: {{property: position, offset: -6}}}}
"""
COMMANDS = 5
"""How many commands without faults may be needed until a goal is reached."""
SLACK = 1.0
"""By how much a call may take longer where this machine is busy, beside what the machine itself was late [s]."""
BUSY = 0.5
"""A machine that is later than this [s] with a thread that sleeps is no measure of how many commands it takes."""
LONGEST_FAULT = 2.0
"""How long a fault lasts at most [s]."""
LATEST = 150
"""How much of what a run does may happen before a fault: an arm tells 200 times a second where it is."""


def bench_in(folder: Path) -> None:
    """Make the example in a folder, with its instruments; cameras of a fourth of the pixels, for time's sake."""
    make_example("shel", folder)
    lab = folder / "lab.yaml"
    lab.write_text(lab.read_text().replace("pixels: [2448, 2048]", "pixels: [1224, 1024]"))
    wiring = (ROOT / "examples" / "devices.yaml").read_text()
    for number, axis in enumerate("yz", 1):
        stage = STAGES.format(axis=axis, number=number)
        wiring = re.sub(rf"  ly_200_{axis}:\n(?:    .*\n)+", lambda _, stage=stage: stage, wiring)  # type: ignore[misc]
    (folder / "devices.yaml").write_text(wiring)


class Trial:
    """One bench, and one thing after the other that goes wrong on it."""

    def __init__(self, folder: Path, seed: int, quiet: bool) -> None:
        self.folder, self.draw, self.quiet = folder, Random(seed), quiet
        self.log, self.late = Log(), Lateness()
        self.wires = Wires(self.log)
        self.count: Counter[str] = Counter()
        self.faults: Counter[str] = Counter()
        self.slow: list[tuple[str, float]] = []
        self.at = "C1"

    def open(self) -> Bench:
        """Open the bench, whose calls are timed."""
        self.wires.tap()
        journalled(self.log)
        ask = Bus.ask

        async def timed(bus: Any, name: str, what: str, *rest: Any, **more: Any) -> Any:
            began = time.monotonic()
            try:
                return await ask(bus, name, what, *rest, **more)
            finally:
                if (took := time.monotonic() - began) > LONGEST + SLACK:
                    self.slow.append((f"{name} was asked to {what} for {took:.1f} s", took))

        Bus.ask = timed  # type: ignore[method-assign]
        return self.reopened()

    def reopened(self) -> Bench:
        """Open the bench, where it was closed."""
        self.bench = Bench.open(self.folder, backend="emulated")
        self.seen()
        assert self.bench.setup.wiring
        self.owners = {n: e.of or n for n, e in self.bench.setup.wiring.devices.items()}
        return self.bench

    def close(self) -> None:
        """Let go of it, and of its wires."""
        self.bench.close()
        self.wires.close()

    # where to

    def goal(self) -> PlanGoal:
        """Return a state to be brought about, at which light does no damage."""
        while True:
            goal = self._drawn()
            with suppress(PicoError):  # a machine that is too busy to look does not know
                if any(d.severity == "error" and d.code == AUDIT for d in self.plan(goal).diagnostics):
                    self.count["goals at which light does damage"] += 1
                    continue
            return goal

    def _drawn(self) -> PlanGoal:
        """Draw a state: most often the next one in the history, with set-points drawn anew."""
        near = STATES[max(0, STATES.index(self.at) - 1) : STATES.index(self.at) + 2]
        self.at = self.draw.choice(STATES if self.draw.random() < 0.2 else near)
        axes = self.draw.sample(sorted(AXES), 3)
        values: dict[str, Any] = {a: round(self.draw.uniform(*AXES[a]), 2) for a in axes}
        wanted = with_values(self.bench.folder.state_at(self.at), values)
        return PlanGoal(wanted, Target(title=f"{self.at}, {', '.join(f'{a} {v}' for a, v in values.items())}"))

    def plan(self, goal: PlanGoal) -> Plan:
        """Return the plan to a state, from the bench as it is."""
        return self.bench.plans.to_state(self.bench.observe(), goal)

    # what goes wrong

    def hurt(self) -> Callable[[], object]:
        """Let something go wrong, and return what mends it."""
        proxies = sorted(self.wires.proxies.items())
        kind = self.draw.choice(("arm", "arm", "wire", "wire", "wire", "gone"))
        if kind == "arm" and self.wires.arms:
            return self._arm(self.wires.arms[0])
        names, proxy = self.draw.choice(proxies)
        fault = "gone" if kind == "gone" else self.draw.choice(FAULTS)
        self.faults[f"{self.device(names)} {fault}"] += 1
        proxy.faults.fault = fault
        if fault == "gone":
            proxy.cut()

        def well() -> None:
            proxy.faults.fault = "none"

        return well

    def device(self, names: tuple[str, ...]) -> str:
        """Return what the devices on a wire are."""
        assert self.bench.setup.wiring
        return self.bench.setup.wiring.devices[names[0]].driver.split(".")[0]

    def _arm(self, arm: Any) -> Callable[[], object]:
        how = self.draw.choice(
            ("drop", "delay", "duplicate", "truncate", "garbage", "freeze", "kill", "restart", "C31")
        )
        self.faults[f"xarm {how}"] += 1
        if how == "freeze":
            arm.freeze()
            return arm.thaw  # type: ignore[no-any-return]
        if how == "kill":
            arm.kill()
            return arm.restart  # type: ignore[no-any-return]
        if how == "restart":
            arm.restart()
        elif how == "C31":
            arm.fault(31)
        else:
            arm.wire(how, times=self.draw.randint(1, 4), seconds=self.draw.uniform(0.1, 1.5))
        return arm.faults.clear  # type: ignore[no-any-return]

    # one after the other

    def cycle(self) -> Iterator[str]:
        """Bring about one state, with something that goes wrong; yield what is wrong with how."""
        goal = self.goal()
        begun = len(self.log.told)
        try:
            hurt = not self.quiet and self.draw.random() < 0.9
            yield from self.command(lambda: self.plan(goal), hurt=hurt)
            fair = 0
            for _ in range(4 * COMMANDS):
                self.person()
                if self.reached(goal):
                    break
                before = self.lateness
                yield from self.command(self.going_on(goal), hurt=False)
                fair += max(before, self.lateness) < BUSY
                if fair >= COMMANDS:
                    yield f"{goal.target.name} was not reached by {COMMANDS} commands: {self.why}"
                    break
            else:
                self.count["given up on a busy machine"] += 1
        finally:
            told = self.log.told[begun:]
            for one in told:
                if one.what == "ended":
                    self.count[one.data.outcome] += 1
                    self.count["moves"] += one.data.outcome == "done" and bool(
                        one.data.data.get("error_mm") is not None
                    )
        yield from self.judged(begun)

    def judged(self, begun: int) -> Iterator[str]:
        """Yield what is wrong with what happened since then."""
        told, setup, world = self.log.told[begun:], self.bench.setup, self.wires.world
        yield from judged.repeated(setup, told, self.owners)
        yield from judged.unended(told)
        yield from judged.unnamed(setup, told)
        yield from judged.misplaced(setup, told, world)
        if (seen := self.seen()) is not None:
            yield from judged.unseen(setup, seen, world, parked=self.parked())

    def seen(self) -> Observation | None:
        """Return what the bench says of itself; None where this machine is too busy to take pictures in time."""
        for _ in range(COMMANDS):
            with suppress(PicoError):
                return self.bench.observe()
        self.count["not looked at"] += 1
        return None

    def going_on(self, goal: PlanGoal) -> Callable[[], Plan]:
        """Return how a person goes on: the run taken up again, hands emptied first, or the goal planned again."""
        self.resumed = None
        how = self.draw.choice(("resume", "recover", "apply"))
        if how == "recover":
            return self.bench.recovery.recover_plan
        if how == "resume":

            def resume() -> Plan:
                try:
                    plan, self.resumed = self.bench.recovery.resume_plan()
                except PicoError as exc:
                    if exc.diagnostics[0].code != "nothing-to-resume":
                        raise
                    return self.plan(goal)
                return plan

            return resume
        return lambda: self.plan(goal)

    resumed: str | None = None
    why = ""
    lateness = 0.0

    def command(self, planned: Callable[[], Plan], *, hurt: bool) -> Iterator[str]:
        """Plan and run; yield what is wrong with how it ends."""
        self.late.take()
        over, stops = threading.Event(), hurt and self.draw.random() < 0.12
        mending: list[threading.Thread] = []
        if hurt and not stops:
            after, lasts = len(self.log.told) + self.draw.randint(0, LATEST), self.draw.uniform(0.05, LONGEST_FAULT)
            mending = [threading.Thread(target=self._hurting, args=(over, after, lasts))]
            mending[0].start()
        try:
            plan, self.why = planned(), ""
            if plan.operations and not plan.errored:
                yield from self.ran(plan, self.draw.uniform(0.0, 10.0) if stops else None)
            elif plan.errored:
                self.why = "; ".join(d.summary for d in plan.diagnostics if d.severity == "error")
        except PicoError as exc:
            self.why = str(exc)
            self.count["commands refused"] += 1
            if exc.exit_code != ExitCode.INTERRUPTED and not judged.named(self.bench.setup, exc.diagnostics):
                yield f"a command failed, and of what is not said: {exc}"
        except Exception as exc:  # what a person would see as a traceback
            yield f"{type(exc).__name__}: {exc}"
            self.why = str(exc)
        finally:
            over.set()
            for thread in mending:
                thread.join()
        self.lateness = self.late.take()
        slack = SLACK + self.lateness
        slow, self.slow = self.slow, []
        yield from (text for text, took in slow if took > LONGEST + slack)

    def ran(self, plan: Plan, stop_after: float | None = None) -> Iterator[str]:
        """Run a plan; yield what is wrong with how it ends."""
        run = self.bench.run(plan, resumes=self.resumed)
        self.resumed = None
        stopping = threading.Timer(stop_after or 0.0, run.stop)
        if stop_after is not None:
            self.faults["stopped"] += 1
            stopping.start()
        for event in run:
            if event.kind == "operation_failed" and not (event.operation and event.component):
                yield f"a failure without operation or component: {event}"
        stopping.cancel()
        self.count["runs"] += 1
        self.why = "; ".join(d.summary for d in run.report.diagnostics) or run.report.outcome
        if stop_after is not None and run.report.outcome == "interrupted":
            self.count["stopped"] += 1
            yield from self._after_a_stop()

    def _after_a_stop(self) -> Iterator[str]:
        since = len(self.log.told)
        before = self.wires.world.world()
        time.sleep(0.5)
        moved = {one.name for one in self.log.told[since:] if one.what in ("moved", "took", "let go")}
        now = self.wires.world.world()
        moved |= {n for n, body in now.components.items() if body.values != before.components[n].values}
        if moved:
            yield f"{', '.join(sorted(moved))} moved after a stop"

    def _hurting(self, over: threading.Event, after: int, lasts: float) -> None:
        """Let something go wrong once so much has happened, and mend it after a while."""
        while len(self.log.told) < after:
            if over.wait(0.01):
                return
        mend = self.hurt()
        over.wait(lasts) if self.draw.random() < 0.5 else time.sleep(lasts)
        mend()

    def person(self) -> None:
        """Do what only somebody at the bench can: look at an arm that met something, and clear that."""
        for arm in self.wires.arms:
            with arm.lock:
                arm.faults.clear()
                if arm.box.error:
                    self.count["cleared by a person"] += 1
                    arm.box.clear()

    def reached(self, goal: PlanGoal) -> bool:
        """Return whether nothing is left to do."""
        self.late.take()
        try:
            plan = self.plan(goal)
            self.why = ", ".join(f"{c.component}.{c.tunable}: {c.text}" for c in plan.changes) or self.why
            return not plan.operations and not plan.errored
        except PicoError as exc:
            self.why, self.lateness = f"not seen: {exc}", max(self.lateness, self.late.take())
        return False

    def parked(self) -> bool:
        """Return whether no arm hides anything."""
        robots = self.bench.setup.lab.robots
        return all(robots[n].is_parked(r.joints) for n, r in self.wires.world.world().robots.items() if n in robots)


def restored(trial: Trial) -> Iterator[str]:
    """Restore E1-1 from E3-2 as a real arm would, and yield what is wrong with how."""
    start, end = "E3-2", "E1-1"
    report = trial.open().apply(start)
    trial.close()
    if report.outcome != "done":
        yield f"{start} was not built: {report.diagnostics}"
        return
    os.environ["PICO_EMULATED_PACE"] = "1"
    bench = trial.reopened()
    simulated = Bench.open(trial.folder)
    simulated.apply(start)
    plan, planned = bench.plans.plan(end), simulated.plans.plan(end)
    simulated.close()
    if [_what(op) for op in plan.operations] != [_what(op) for op in planned.operations]:
        yield f"the simulator plans {len(planned.operations)} other operations than these {len(plan.operations)}"
    begun, began = len(trial.log.told), time.monotonic()
    yield from trial.ran(plan)
    took = time.monotonic() - began
    yield from trial.judged(begun)
    left = bench.plans.plan(end)
    if left.operations or left.errored:
        yield f"{end} is not reached: {', '.join(c.text for c in left.changes)} {left.diagnostics}"
    print(f"{len(plan.operations)} operations in {took:.0f} s, {plan.makespan:.0f} s planned, {start} to {end}")


def _what(op: Operation) -> tuple[object, ...]:
    return op.id, op.primitive, op.component, op.arguments.get("tunable"), op.after


def main() -> int:
    """Hurt, and judge."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--operations", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quiet", action="store_true", help="without faults")
    parser.add_argument("--restoration", action="store_true", help="one of the paper's, at the pace of a real arm")
    parser.add_argument("--keep", type=Path, help="where the bench is left")
    given = parser.parse_args()
    wrong, began = 0, time.monotonic()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "shel"
        bench_in(folder)
        trial = Trial(folder, given.seed, given.quiet)
        try:
            if given.restoration:
                for text in restored(trial):
                    wrong += 1
                    print(f"wrong: {text}", flush=True)
                return 1 if wrong else 0
            trial.open()
            while (ended := sum(trial.count[o] for o in ("done", "failed", "unknown"))) < given.operations:
                for text in trial.cycle():
                    wrong += 1
                    print(f"wrong, after {ended} operations: {text}", flush=True)
                print(
                    f"  {ended} operations, {time.monotonic() - began:.0f} s, at {trial.at}: {trial.why[:200]}",
                    flush=True,
                )
        except KeyboardInterrupt:  # what was found until then is told
            pass
        finally:
            trial.close()
        if given.keep:
            shutil.copytree(folder, given.keep)
    told = ", ".join(f"{n} {what}" for what, n in sorted(trial.count.items()))
    print(f"{told}; {time.monotonic() - began:.0f} s: {wrong} wrong")
    print("faults: " + ", ".join(f"{n} {what}" for what, n in sorted(trial.faults.items())))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
