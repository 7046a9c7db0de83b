"""How a bench stands against HEAD, once or again and again: what leaves it, what is right again or brought back."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pico.bench.by_light import unaligned, unfound
from pico.bench.cut_short import told_first
from pico.bench.drifting.drift import PASSING, Drift, Drifted, LightLost, calibration_drift, drift, news, require_heal
from pico.bench.drifting.healing import Healing
from pico.bench.in_use import moved_by
from pico.bench.moves import Moves
from pico.bench.opened import Opened
from pico.bench.plans import Plans
from pico.diagnostics import ExitCode, PicoError
from pico.model.comparing.drift import drift_of
from pico.model.diff import unread_values
from pico.model.lab import HealLimit
from pico.model.observation import LACKING, Observation
from pico.model.record import record
from pico.model.trace.report import RunReport
from pico.runs.unstated_settings import looked_up, tell

if TYPE_CHECKING:
    from pico.model.comparing.status import Status
    from pico.model.state import LabState
    from pico.runs.journal import JournalRecord


@record
class Told:
    """One look: what has drifted, or drifted on, since the one before it (`fresh`), the addresses of what is `right`
    again, and a `note` on what was healed, or why it was not. `first`: nothing was looked at before."""

    found: Drifted
    fresh: tuple[Drift, ...]
    right: tuple[str, ...]
    note: str = ""
    first: bool = False

    @property
    def new(self) -> bool:
        """Whether there is anything to tell."""
        return bool(self.fresh or self.right or self.note)


class Watch:
    """How one bench stands against the last commit, and what keeps it there."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened

    def status(self) -> Status:
        """Return committed, desired and live side by side."""
        from pico.model.comparing.status import compare

        folder = self.opened.folder
        seen = self._with_own(self.opened.observe(), folder.state)
        head, committed, memory = self.opened.history.head_name(), folder.committed(), self.opened.edge.memory
        missed = unaligned(folder.setup, memory, seen, folder.state)
        unstated = looked_up(folder.setup, memory, seen, committed, folder.state)
        found = compare(folder.setup, committed, folder.state, seen, head, unaligned=missed, unstated=unstated)
        lacking = tuple(one for one in seen.problems if one.code in LACKING)
        return replace(found, cut_short=told_first(self.opened, seen), lacking=lacking)

    def look(self) -> Drifted:
        """Look at the bench and return where it has left HEAD: by how much, how surely, and who did it. Moves nothing,
        needs no lock; raises PicoError."""
        setup = self.opened.setup
        head = self.opened.folder.committed() or self.opened.folder.state_at("HEAD")  # which says why there is none
        seen = self._with_own(self.opened.observe(), head)
        changes = (*drift_of(setup, seen, head), *unfound(setup, self.opened.edge.memory, seen, head))
        rules = set(setup.lab.policy.ignore)
        ignored = [c for c in changes if rules & {c.component, f"{c.component}.{c.tunable}"}]
        kept = [c for c in changes if c not in ignored]
        records = self._records() if any(not c.tolerated for c in kept) else ()
        found = [drift(setup, seen, change, records, self._end_of) for change in kept]
        beyond = tuple(d for d in found if not d.change.tolerated)
        return Drifted(
            head=self.opened.history.head_name(), observed_at=seen.observed_at, beyond=beyond,
            within=tuple(d for d in found if d.change.tolerated),
            ignored=tuple(f"{c.component}.{c.tunable}" for c in ignored), held=self._held(seen, beyond),
            cut_short=told_first(self.opened, seen), light=tuple(self._light_lost(seen, head, beyond)) or None,
            unread=unread_values(seen, head), unstated=tell(setup, self.opened.edge.memory, seen, head),
        )  # fmt: skip

    def _with_own(self, seen: Observation, state: LabState) -> Observation:
        """Return what was seen, with the tunables that stay where light has them whatever a state says."""
        if not self.opened.setup.lab.goals:
            return seen
        from pico.bench.alignment.own_values import with_own_values

        return with_own_values(self.opened, seen, state)

    def _light_lost(self, seen: Observation, head: LabState, beyond: Sequence[Drift]) -> Iterator[LightLost]:
        """Yield the goals whose light is lost, or comes through what has moved; nothing is measured."""
        setup = self.opened.setup
        if not setup.lab.goals:
            return
        from pico.bench.aligned import standing
        from pico.planning.goal_light import goal_light
        from pico.planning.verifying import as_wanted

        right = as_wanted(setup, seen, head)
        try:
            stands = standing(self.opened, seen, timed=False)
        except PicoError:  # a journal that can't be read: looking must not fail for it
            return
        for one in stands:
            goal = setup.lab.goals.get(one.goal)
            light = goal_light(setup, right, goal) if goal else None
            if goal is None or light is None or light.order is None:
                continue
            inside = [d for d in beyond if d.change.component in light.parts - light.beyond]
            moved = tuple(
                d.address for d in inside if d.address not in goal.tunables and d.change.tunable not in PASSING
            )
            if one.status == "lost" or (one.status == "aligned" and moved):
                yield LightLost(goal=one.goal, lost=one.status == "lost", why=one.why, at=one.at, moved=moved)

    def _records(self) -> Sequence[JournalRecord]:
        """Return what the bench remembers; nothing where that can't be read: looking must not fail for it."""
        try:
            return memory.records() if (memory := self.opened.edge.memory) else ()
        except PicoError:
            return ()

    def _end_of(self, run: str) -> Mapping[str, Any] | None:
        """Return how the bench was observed at the end of a run; None if nobody knows."""
        try:
            return memory.about(run)[1] if (memory := self.opened.edge.memory) else None
        except PicoError:
            return None

    def _held(self, seen: Observation, beyond: Sequence[Drift]) -> str:
        """Return why nothing may be brought back now."""
        if who := moved_by(self.opened):
            return f"a run goes on: {who}"
        if seen.person is not False:
            return "somebody is at the table" if seen.person else "nothing tells whether somebody is at the table"
        hands = [name for name, robot in sorted(seen.robots.items()) if robot.holding]
        if hands:
            return f"{hands[0]} holds {seen.robots[hands[0]].holding}: `pico recover` first"
        wrong = next((p for p in seen.problems if p.severity == "error"), None)
        return wrong.summary if wrong else calibration_drift(self.opened.setup, beyond)

    def heal(self, found: Drifted, leave: Collection[str] = ()) -> RunReport | None:
        """Bring back what drifted and no operation put where it is, but for some components; None where there is
        nothing.

        Raises PicoError: DENIED where the lab's policy does not allow it, and where that can't or must not be run.
        """
        require_heal(self.opened.setup)
        names = sorted({d.change.component for d in found.beyond if d.by != "operation"} - set(leave))
        if found.held or not names:
            return None
        kinds = {name: self.opened.setup.type_of(name).tunables for name in names}
        drifted = {(d.change.component, d.change.tunable) for d in found.beyond}
        kept = [  # light that is asked for, and what light has the last word on, but for what has drifted itself
            f"{n}.{t}" for n, own in kinds.items() for t, kind in own.items()
            if kind.restore.kind == "request" or (kind.restore.kind == "align" and (n, t) not in drifted)
        ]  # fmt: skip
        plan = Plans(self.opened).plan("HEAD", targets=names, exclude=kept)
        if plan.errored:
            raise PicoError([d for d in plan.diagnostics if d.severity == "error"], ExitCode.IMPOSSIBLE)
        return Moves(self.opened).apply(plan.because("heal")) if plan.operations else None

    def watch(self, *, interval: float = 10.0, looks: int | None = None, heal: bool = False) -> Iterator[Told]:
        """Return the looks at the bench, `interval` seconds apart, without an end where `looks` is None.

        `heal`: bring back what drifted, each time that it does, as often as the policy's `heal_limit` allows. Raises
        PicoError, DENIED at once where the lab's policy does not allow that.
        """
        healing = None
        if heal:
            require_heal(self.opened.setup)
            limit = self.opened.setup.lab.policy.heal_limit or HealLimit()
            healing = Healing(self.heal, limit, time.monotonic)
        return _watch(self.look, healing, interval, looks)


def _watch(
    look: Callable[[], Drifted], healing: Healing | None, interval: float, looks: int | None,
    sleep: Callable[[float], None] = time.sleep,
) -> Iterator[Told]:  # fmt: skip
    before: tuple[Drift, ...] = ()
    for number in itertools.count() if looks is None else range(looks):
        if number:
            sleep(interval)
        found = look()
        note = healing.after(found) if healing else ""
        fresh, right = news(before, found.beyond)
        before = found.beyond
        yield Told(found=found, fresh=tuple(fresh), right=tuple(right), note=note, first=not number)
