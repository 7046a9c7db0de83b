"""The lasers of a bench: what lets them emit, arming them and shutting them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import datetime, timedelta
from typing import TYPE_CHECKING

from pico.backends.hardware.guard.note import CODE as GUARD
from pico.base import clock
from pico.bench.cut_short import unattended
from pico.bench.opened import Opened
from pico.bench.plans import Plans
from pico.diagnostics import Diagnostic, ExitCode, PicoError, did_you_mean, error, warning
from pico.model.arming import Arming, LaserClass, Licence
from pico.model.observation import Observation, with_value
from pico.model.record import record
from pico.places.bench import BenchPlace
from pico.planning.checks.beams import shutter_of
from pico.planning.checks.emission import licensed, may_shine
from pico.policy import arming as policy

if TYPE_CHECKING:
    from pico.model.plan import Plan
    from pico.model.trace.report import RunReport

HOURS = 1.0
"""So long a laser is armed where nobody says how long."""


@record
class LaserRow:
    """One laser: its class as it is set, whether it emits, what its shutter (or the one in its beam) is at, and what
    lets it emit: `low` (class 1 or 2), `waived`, `armed`, or `nothing`; of an arming, by whom, in which role, from when
    (where it has not begun), until when, and for which class. `broken`: what is wrong with what the bench keeps of it.
    """

    laser: str
    laser_class: LaserClass
    power: float
    emits: bool
    emission: bool | None = None
    gate: str = ""
    shutter: str = ""
    lets: str = "nothing"
    arming: Arming | None = None
    begun: bool = False
    broken: str = ""


class Lasers:
    """The lasers of one bench."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened
        self.notices: tuple[Diagnostic, ...] = ()
        """What the guard of the bench had to say when `rows` looked last."""

    def rows(self) -> tuple[LaserRow, ...]:
        """Return the lasers of the bench, by name. Moves nothing."""
        seen = self.opened.observe()
        self.notices = tuple(problem for problem in seen.problems if problem.code == GUARD)
        kept = {one.laser: one for one in self.opened.wait(self.opened.edge.armings())}
        found = []
        for name in policy.lasers(self.opened.setup):
            row = self._row(seen, name)
            one = kept.get(name)
            if one is not None:
                given = (
                    one.arming if one.arming and not policy.over(self.opened.setup, one.arming, clock.now()) else None
                )
                row = replace(
                    row, arming=given, broken=one.broken, begun=given is not None and given.begins <= clock.now()
                )
            found.append(row)
        return tuple(found)

    def _row(self, seen: Observation, name: str) -> LaserRow:
        from pico.optics.audit.lasers import laser_class

        setup, values = self.opened.setup, seen.known_values
        own = values.get(name, {})
        gate = name if "shutter" in setup.type_of(name).tunables else shutter_of(setup, seen, (), name) or ""
        of, power = laser_class(setup, name, own)
        licence = (seen.licences or {}).get(name)
        lets = "low" if licensed(replace(seen, licences=None), name, of) else _lets(licence, of)
        shut = values.get(gate, {}).get("shutter") if gate else None
        emission = own.get("emission")
        return LaserRow(
            laser=name, laser_class=of, power=power, gate=gate, shutter=str(shut or ""), lets=lets,
            emission=emission if isinstance(emission, bool) else None,
            emits=may_shine(setup, seen, name, own) and shut != "closed",
        )  # fmt: skip

    def arming(
        self, laser: str, *, hours: float = HOURS, laser_class: LaserClass | None = None, role: str | None = None,
        begins: datetime | None = None, unattended: bool = False, person: str | None = None,
    ) -> Arming:  # fmt: skip
        """Return the arming that a person may give; nothing is armed by it yet.

        `laser_class`: the greatest that it may emit as, that of what it is set to where None. `person`: who gives it,
        Git's user.name where None. Raises PicoError (exit code DENIED) where the lab's policy does not allow that.
        """
        setup, seen = self.opened.setup, self.opened.observe()
        if laser not in policy.lasers(setup):
            hint = did_you_mean(laser, policy.lasers(setup)) or f"here: {', '.join(policy.lasers(setup)) or 'none'}"
            raise PicoError(error("unknown-component", f"there is no laser `{laser[:40]}`", hint=hint))
        now = self._row(seen, laser)
        of, who = laser_class or now.laser_class, person or person_of(self.opened)
        role = role or policy.role_for(setup, who, of, hours)
        if role is None:
            why = policy.needless if now.lets in ("low", "waived") else policy.nobody
            raise PicoError(why(setup, who, laser, of, hours), ExitCode.DENIED)
        start = begins or clock.parse(clock.now())
        given = Arming(
            laser=laser, by=who, role=role, laser_class=of, begins=clock.as_text(start),
            ends=clock.as_text(start + timedelta(hours=hours)), backend=self.opened.backend_name,
            unattended=unattended or None,
        )  # fmt: skip
        if wrong := policy.refusal(setup, given, clock.now()):
            raise PicoError(wrong, ExitCode.DENIED)
        return given

    def plan(self, given: Arming) -> Plan:
        """Return the plan that opens a laser as an arming will allow, with what the beam audit says; raises PicoError.
        Its operations are none where the laser emits already; the audit is of it as if it were opened now."""
        plans, seen = Plans(self.opened), self.opened.observe()
        licence = Licence(laser_class=given.laser_class, by=given.by, ends=given.ends, unattended=given.unattended)
        armed = replace(seen, licences={**(seen.licences or {}), given.laser: licence})
        row = self._row(seen, given.laser)
        if row.emits:
            shut = with_value(
                armed, *((row.gate, "shutter", "closed") if row.gate else (given.laser, "emission", False))
            )
            opening = self._opening(plans, given, shut)
            return opening if opening.exit_code else self._opening(plans, given, armed)
        return self._opening(plans, given, armed)

    def _opening(self, plans: Plans, given: Arming, armed: Observation) -> Plan:
        from pico.planning import arm_one

        planner = plans.planner(armed)
        found = planner.plan(arm_one(planner, given.laser))
        title = f"{given.laser} armed by {given.by} ({given.role}) up to class {given.laser_class} until {given.ends}"
        return plans.judged(replace(found, target=replace(found.target, title=title)).sealed(), armed)

    def keep(self, given: Arming) -> Arming:
        """Let the bench keep an arming, and move nothing: for runs that come later. Raises PicoError."""
        return self.opened.wait(self.opened.edge.arm(given))

    def open(self, given: Arming, plan: Plan, run: Callable[[Plan], RunReport]) -> RunReport | None:
        """Arm a laser and open it by its plan, which `run` runs; None where nothing had to be opened. Where that fails
        it is disarmed again. Raises PicoError."""
        self.keep(given)
        if not plan.operations:
            return None
        try:
            report = run(plan)
        except BaseException:
            self.disarm(given.laser)
            raise
        if report.outcome != "done":
            self.disarm(given.laser)
        return report

    def arm(self, laser: str, *, hours: float = HOURS, laser_class: LaserClass | None = None) -> RunReport | None:
        """Arm a laser as the person of Git's user.name, and open it; see `arming` and `open`."""
        from pico.bench.moves import Moves

        given = self.arming(laser, hours=hours, laser_class=laser_class)
        plan = self.plan(given)
        if plan.exit_code:
            raise PicoError([d for d in plan.diagnostics if d.severity == "error"], plan.exit_code)
        return self.open(given, plan, Moves(self.opened).apply)

    def disarm(self, laser: str) -> bool:
        """End what arms a laser, and shut it, whoever has the bench and whichever worktree is attached to it.

        Returns whether it is shut by now. Raises PicoError for what is no laser.
        """
        if laser not in policy.lasers(self.opened.setup):
            hint = did_you_mean(laser, policy.lasers(self.opened.setup))
            raise PicoError(error("unknown-component", f"there is no laser `{laser[:40]}`", hint=hint))
        opened, person = self.opened, person_of(self.opened) or "somebody"
        place = opened.place.attached if isinstance(opened.place, BenchPlace) else opened.place
        if place == opened.place:
            return opened.wait(opened.edge.disarm(laser, person))
        from pico.bench.opened import Opened

        with Opened.open(
            place.root, bench=place, fidelity=opened.fidelity, safety="light"
        ) as there:  # in another worktree
            return there.wait(there.edge.disarm(laser, person))


def light(opened: Opened) -> tuple[Diagnostic, ...]:
    """Return which lasers emit now, and what an unattended run is held to or how it left the bench. Raises PicoError if
    nothing can be seen."""
    emitting = [
        warning("light", f"{row.laser} (class {row.laser_class}) emits",
                hint=f"`pico laser disarm {row.laser}` shuts it", address=row.laser)
        for row in Lasers(opened).rows() if row.emits
    ]  # fmt: skip
    return (*unattended(opened), *emitting)


def _lets(licence: Licence | None, of: LaserClass) -> str:
    from pico.model.arming import within

    if licence is None or not within(of, licence.laser_class):
        return "nothing"
    return "armed" if licence.by else "waived"


def person_of(opened: Opened) -> str:
    """Return who sits here, as Git's `user.name` has it; empty where nobody said."""
    from pico.history.git.command import answer

    return answer(opened.root, ["config", "user.name"]).strip()
