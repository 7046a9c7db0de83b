"""Optimizations as operations: what their measurements need is set first, and set back when they are done."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError, error
from pico.model.goal import Goal
from pico.model.observation import Observation, astray
from pico.model.operation import Operation, Reason, new_id, touched_by
from pico.model.quantities import Value
from pico.model.record import as_json
from pico.model.setpoint import set_seconds
from pico.model.setup import EXPOSURE, Setup
from pico.model.vocabulary import measured_in
from pico.motion.types import Motion
from pico.optimize.registry import algorithm_file
from pico.planning.checks.emission import lets_out
from pico.planning.checks.interlocks import LAMP
from pico.planning.foreseen import foreseen
from pico.planning.goal_light import goal_light
from pico.planning.measuring import Need, granted, kept_shut, needed, setting
from pico.planning.parts.setdown import park_operation
from pico.planning.sought import Sought, arguments_of
from pico.planning.unknown_values import unknown_start

if TYPE_CHECKING:
    from pico.optics.nominal.feeding import Right

TAKES = 0.5
"""What a measurement takes, with the table at rest [s]."""
ASKED = Reason(kind="asked")


@dataclass(frozen=True)
class Turn:
    """A goal whose turn it is, those that are sought `first` where it is dark, in the same operation; what it `took`
    before [s], None where nobody knows; and why it is sought. `right`: benches with the light that it is to have: its
    tunables make up first for how parts stand otherwise than in the first of these that is this bench still. `verify`:
    it is measured where its tunables stand, and not sought; `was`: what was measured when it was met."""

    one: Sought
    first: tuple[Sought, ...] = ()
    took: float | None = None
    reason: Reason = ASKED
    right: tuple[Right, ...] = ()
    verify: bool = False
    was: Mapping[str, float] | None = None

    @property
    def stages(self) -> tuple[Sought, ...]:
        """All that is sought, in order."""
        return (*self.first, self.one)

    @property
    def texts(self) -> tuple[str, ...]:
        """What is measured for it."""
        return tuple(text for stage in self.stages for text in stage.goal.texts)


def optimizing(
    setup: Setup, seen: Observation, turns: Sequence[Turn], motion: Motion | None, before: Sequence[Operation] = ()
) -> list[Operation]:
    """Return the operations that bring light to goals, one after the other: arms that stand out park, what is measured
    gets what it needs, an optimization for each, and all is set back at the end; what a goal wants only during its own
    is set back before one that does not want it.

    `before`: operations that come first, after which the bench will be as `seen`. Each comes only after those of
    `before` and of the earlier goals that its light depends on. Raises PicoError where a tunable of a goal is not
    known, for it is set back.
    """
    return _Block(setup, seen, turns, motion, before).made()


class _Block:
    """Optimizations one after the other, while they are put together."""

    def __init__(
        self, setup: Setup, seen: Observation, turns: Sequence[Turn], motion: Motion | None,
        before: Sequence[Operation],
    ) -> None:  # fmt: skip
        self.setup, self.seen, self.turns, self.motion, self.before = setup, seen, turns, motion, before
        self.out: list[Operation] = []
        self.arms = [op.id for op in before if op.robot or op.kind.by_hand]
        self.latest: dict[str, str] = {}
        """Which operation of the block set a tunable last, by address."""
        self.now: dict[str, Need] = {}
        """What is set otherwise than it was, by address, as the need that wants it so."""
        self.made_of: dict[str, Turn] = {}
        """The operations in which the goals have their turns."""

    def made(self) -> list[Operation]:
        working = {op.robot for op in self.before}
        for robot in astray(self.setup, self.seen):
            if robot not in working:
                self.arms.append(self._add(park_operation(self.setup, self.seen, robot, (), self.motion)))
        names = ", ".join(turn.one.name for turn in self.turns)
        for need in self._needs():
            self._set(need, f"to measure for {names}", self.arms if need.opens else [])
        lasting = {*self.now}
        for turn in self.turns:
            during = {need.address: need for need in self._during(turn.one.goal)}
            for address in [a for a in self.now if a not in lasting and a not in during]:
                self._set_back(address, "as it was before that")
            for need in during.values():
                own = [op.id for op in self.before if op.component == need.component]
                waits = self.arms if self._lights(need) else own
                self._set(need, f"while {turn.one.name} is {'measured' if turn.verify else 'sought'}", waits)
            (self._verify if turn.verify else self._optimize)(turn)
        for address in [*self.now]:
            self._set_back(address, f"as it was before {names}")
        return self.out

    def _needs(self) -> Iterator[Need]:
        """Yield what the measurements of all goals need, and is not so, or not for sure while arms park."""
        texts = [text for turn in self.turns for text in turn.texts]
        known = {
            need.address: need
            for component, measurable in measured_in(self.setup, texts)
            for need in granted(self.setup, self.seen, self._wants(component, measurable))
        }
        parks = any(op.kind.parks for op in self.out)
        yield from (n for n in known.values() if n.live != n.value or (parks and n.opens))

    def _wants(self, component: str, measurable: str) -> Iterator[Need]:
        return needed(self.setup, self.seen, component, self.setup.measurables_of(component)[measurable])

    def _during(self, goal: Goal) -> Iterator[Need]:
        for address, value in (goal.during or {}).items():
            component, _, tunable = address.partition(".")
            part = self.seen.components.get(component)
            live = part.values.get(tunable) if part is not None else None
            known = live.value if live is not None and live.status == "known" else None
            yield Need(component=component, tunable=tunable, value=value, live=known)

    def _lights(self, need: Need) -> bool:
        """Whether setting what is needed may bring other light to where arms work: beams are shut then, but where the
        Lab leaves them open."""
        made = setting(self.setup, need, need.live, need.value, (), "")
        return self.setup.lab.policy.open_beam or need.tunable == LAMP or lets_out(self.setup, made)

    def _set(self, need: Need, text: str, waits: Sequence[str]) -> None:
        """Set what is needed, where it is not so already."""
        live = self.now[need.address].value if need.address in self.now else need.live
        if live == need.value and not (need.address not in self.now and need.opens and waits):
            return
        after = _once(*waits, *self._after(need.address), *self.made_of)
        self.latest[need.address] = self._add(setting(self.setup, need, live, need.value, after, text))
        self.now[need.address] = replace(need, live=self.now.get(need.address, need).live)

    def _set_back(self, address: str, text: str) -> None:
        """Set a tunable back to what it was before the block, after the optimizations that wanted it."""
        need = self.now.pop(address)
        if need.live is None or need.live == need.value or kept_shut(self.setup, self.seen, need):
            return
        after = _once(*self._after(address), *self.made_of)
        self.latest[address] = self._add(setting(self.setup, need, need.value, need.live, after, text))

    def _optimize(self, turn: Turn) -> None:
        setup, here = self.setup, foreseen(self.setup, self.seen, self.out)
        begin = {a: v for stage in turn.stages for a, v in _from(setup, here, stage.name, stage.goal).items()}
        only = {a: v for stage in turn.stages for a, v in _to_measure(setup, here, stage.goal).items()}
        light = goal_light(setup, self.seen, turn.one.goal).parts
        own = [op.id for op in self.before if _touches(op, light)]
        own += [
            i for i, made in self.made_of.items() if any(a.partition(".")[0] in light for a in made.one.goal.tunables)
        ]
        made_up = (absorbed(setup, here, turn.one.goal, bench) for bench in turn.right)
        for address, value in next((found for found in made_up if found is not None), _aim(turn.one, begin)).items():
            self.latest[address] = self._add(
                _absorbing(setup, address, begin[address], value, _once(*self.arms, *self._after(address)))
            )
            begin = {**begin, address: value}
        parts = sorted({address.partition(".")[0] for address in begin})
        looked = {a for stage in turn.stages for found in (stage.goal.looks or {}).values() for a in found}
        measured = {component for component, _ in measured_in(setup, turn.texts)}
        detectors = sorted(measured | {a.partition(".")[0] for a in looked})
        made = self._add(Operation(
            id=new_id(), primitive="optimize", component=parts[0], reason=turn.reason,
            arguments={
                "from": {**only, **begin}, "specimens": specimens(setup), **arguments_of(setup, turn.one, turn.first),
            },
            after=_once(*self.arms, *own, *self.latest.values()),
            seconds=reckoned(setup, turn.stages) if turn.took is None else turn.took,
            resources=tuple(dict.fromkeys((*begin, *sorted(looked), *parts, *detectors, *sorted(setup.lab.robots)))),
        ))  # fmt: skip
        self.made_of[made] = turn

    def _verify(self, turn: Turn) -> None:
        setup, here, goal = self.setup, foreseen(self.setup, self.seen, self.out), turn.one.goal
        begin = {address: live_number(here, address) for address in goal.tunables}
        looked = {address for settings in (goal.looks or {}).values() for address in settings}
        measured = measured_in(setup, goal.texts)
        what = {"goal": turn.one.name, "what": goal, **({"was": turn.was} if turn.was else {})}
        made = self._add(Operation(
            id=new_id(), primitive="verify", component=measured[0][0], reason=turn.reason,
            arguments={
                "from": {**_to_measure(setup, here, goal), **begin}, "specimens": specimens(setup), **as_json(what),
            },
            after=_once(*self.arms, *self.latest.values(), *self.made_of),
            seconds=TAKES * max(1, len(goal.looks or ())) * len(measured),
            resources=tuple(dict.fromkeys(
                (*sorted(looked), *(name for name, _ in measured), *sorted(setup.lab.robots))
            )),
        ))  # fmt: skip
        self.made_of[made] = turn

    def _after(self, address: str) -> list[str]:
        """Return what set a tunable last: of this block, else of what comes before it."""
        if address in self.latest:
            return [self.latest[address]]
        return [op.id for op in self.before if address in {f"{c}.{t}" for c, t in _sets(op)}]

    def _add(self, operation: Operation) -> str:
        if operation.reason.kind == "interlock":
            names = tuple(turn.one.name for turn in self.turns if turn.reason.kind == "align")
            operation = replace(operation, reason=replace(operation.reason, of=names))
        self.out.append(operation)
        return operation.id


def _once(*ids: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys(ids))


def _sets(op: Operation) -> tuple[tuple[str, str], ...]:
    return touched_by(op.component, op.arguments) if op.kind.mutating else ()


def _touches(op: Operation, light: Collection[str]) -> bool:
    """Whether light is another by an operation: a part in it moves or is set, a lamp goes out."""
    lamp = op.arguments.get("tunable") == LAMP
    return op.kind.mutating and (lamp or any(component in light for component, _ in _sets(op)))


def absorbed(setup: Setup, seen: Observation, goal: Goal, right: Right) -> dict[str, float] | None:
    """Return what tunables of a goal are to be set to first, so that they make up for how parts stand otherwise than
    where light was right: within the goal's bounds, and within the trim of each around where it was. None where nobody
    can tell."""
    from pico.optics.nominal.feeding import fed_forward

    limits = {}
    for address, (low, high) in goal.tunables.items():
        component, _, tunable = address.partition(".")
        restore = setup.type_of(component).tunables[tunable].restore
        part = right.state.components.get(component)
        was = part.values.get(tunable) if part else None
        if restore.kind == "align" and restore.trim is not None and isinstance(was, int | float):
            low, high = max(low, was - restore.trim), min(high, was + restore.trim)
        limits[address] = (low, high)
    if any(low >= high for low, high in limits.values()):
        return None
    return fed_forward(setup, seen, goal, right, limits)


def _absorbing(setup: Setup, address: str, before: float, after: float, waits: Sequence[str]) -> Operation:
    component, _, tunable = address.partition(".")
    return Operation(
        id=new_id(), primitive="set", component=component,
        reason=Reason(kind="asked", text="makes up for how parts stand"),
        arguments={"tunable": tunable, "from": before, "to": after}, after=tuple(waits),
        resources=(address, component), seconds=set_seconds(setup.type_of(component).tunables[tunable], before, after),
    )  # fmt: skip


def _aim(one: Sought, begin: Mapping[str, float]) -> dict[str, float]:
    """Return the tunables that do not stand where a goal is likely to be met, with what they are set to."""
    aim = {a: round(v, 3) for a, v in (one.aim or {}).items()}
    return {address: value for address, value in aim.items() if value != begin.get(address)}


def specimens(setup: Setup) -> Mapping[str, str]:
    """Return the serial numbers of the parts that have one: what light was brought to a goal with."""
    return {name: part.serial for name, part in sorted(setup.lab.inventory.items()) if part.serial}


def reckoned(setup: Setup, stages: Iterable[Sought]) -> float:
    """Return what optimizations take [s] one after the other, with what is known of each before it begins."""
    return sum(seconds(setup, one.goal, one.algorithm, told=bool(one.known and one.known.slopes)) for one in stages)


def seconds(setup: Setup, goal: Goal, algorithm: str, *, told: bool = False) -> float:
    """Return what an optimization takes [s] as a plan reckons it: the usual number of measurements, each after a step
    of an eighth of the range of the slowest tunable. `told`: how readings follow the tunables is known before."""
    steps = []
    for address, (low, high) in goal.tunables.items():
        component, _, tunable = address.partition(".")
        kind = setup.type_of(component).tunables[tunable]
        steps.append(set_seconds(kind, low, low + (high - low) / 8))
    declared = algorithm_file(algorithm).DECLARATION
    usual = (declared.told if told else 0) or declared.usual
    many = max(1, len(goal.looks or ())) * len(measured_in(setup, goal.texts))
    return min(goal.budget.seconds, min(usual, goal.budget.measurements) * (max(steps) + many * TAKES))


def _to_measure(setup: Setup, seen: Observation, goal: Goal) -> Mapping[str, Value]:
    """Return what may be set on the way only to be measured by, as it is, by address: the exposures of detectors, and
    what looks set."""
    looked = {address for settings in (goal.looks or {}).values() for address in settings}
    exposed = {f"{c}.{EXPOSURE}" for c, _ in measured_in(setup, goal.texts) if setup.ranges(c)}
    found = dict[str, Value]()
    for address in sorted(looked | exposed):
        component, _, tunable = address.partition(".")
        part = seen.components.get(component)
        live = part.values.get(tunable) if part else None
        if live is not None and live.status != "unknown" and live.value is not None:
            found[address] = live.value
        elif address in looked:
            text = f"nobody knows {address}, so that nobody could set it back"
            raise PicoError(error("goal", text, hint=f"`pico set {address} VALUE` first", address=address))
    return found


def live_number(seen: Observation, address: str) -> float | None:
    """Return where a tunable stands; None where nobody knows, or it is no number."""
    component, _, tunable = address.partition(".")
    part = seen.components.get(component)
    live = part.values.get(tunable) if part is not None and part.presence == "seen" else None
    known = live is not None and live.status != "unknown" and isinstance(live.value, int | float)
    return float(live.value) if known else None  # type: ignore[union-attr,arg-type]


def _from(setup: Setup, seen: Observation, name: str, goal: Goal) -> Mapping[str, float]:
    found = {}
    for address in goal.tunables:
        live = live_number(seen, address)
        if live is None:
            raise PicoError(unknown_start(setup, address, "goal"))
        found[address] = live
        low, high = goal.tunables[address]
        if not low <= live <= high:
            text = f"{address} stands at {live:g}, outside {low:g} to {high:g}, within which {name} is sought"
            near = low if live < low else high
            raise PicoError(error("goal", text, hint=f"`pico set {address} {near:g}` brings it there", address=address))
    return found
