"""What an edge lets emit: no operation lets light out of a laser above class 2 without a licence, whoever asks for it,
and a laser whose arming is over is shut."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.backends.device import Began, Capabilities, Commissioned, Device, LightGuarded
from pico.backends.hardware.report import read
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error, warning
from pico.edge import armings
from pico.model.arming import Arming, LaserClass
from pico.model.observation import Observation, live_state
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.plan import UNARMED, Base, LabRef, Plan, Target
from pico.model.setup import Setup
from pico.optics.audit.lasers import laser_class
from pico.optics.audit.limits import above_class_2
from pico.places.bench import BenchPlace
from pico.planning.checks.beams import shutter_of
from pico.planning.checks.emission import above, is_dark, lets_out, licensed, may_shine, refused, uncovers, why_not
from pico.policy import arming, commissioning
from pico.vision.calibration_files import calibration_digest

if TYPE_CHECKING:
    from pico.edge.attempts import Executing

DEAD_MAN = "dead-man"
"""The code of what is said of a laser whose light nothing would end without PICO."""
Looking = Callable[[], Awaitable[Observation]]


class Guarded:
    """A device that lets light out only by a licence, of no higher class than `most` where nobody is there; where no
    plan asks for it (`bare`) only after the beam audit."""

    def __init__(
        self, setup: Setup, inner: Executing, look: Looking, bare: Callable[[], bool],
        most: Callable[[], LaserClass | None], refused_by: Callable[[], Diagnostic | None] = lambda: None,
        kept_in: Callable[[], Diagnostic | None] = lambda: None,
    ) -> None:  # fmt: skip
        """`refused_by`: why nothing but ending light is let through now; `kept_in`: why no light is let out."""
        self._setup, self._inner, self._look, self._bare, self._most = setup, inner, look, bare, most
        self._refused_by, self._kept_in = refused_by, kept_in

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """Execute an operation; one that lets light out and must not fails, and nothing moves."""
        if not _darkens(operation) and (why := self._refused_by()) is not None:
            return OperationResult(key=key, outcome="failed", error=why)
        if not (lets_out(self._setup, operation) or uncovers(self._setup, operation)):
            return await self._inner.execute(operation, key, began)
        if (why := self._kept_in()) is not None:
            return OperationResult(key=key, outcome="failed", error=why)
        seen = await self._look()
        wrong: Sequence[Diagnostic] = refused(self._setup, seen, [operation])
        if not wrong and (most := self._most()) is not None:
            wrong = above(self._setup, seen, [operation], most)
        if not wrong and self._bare():
            wrong = _unsafe(self._setup, seen, operation)
        if wrong:
            return OperationResult(key=key, outcome="failed", error=wrong[0], ended=seen.time)
        return await self._inner.execute(operation, key, began)


def _darkens(operation: Operation) -> bool:
    said = operation.arguments
    return operation.primitive == "set" and is_dark(str(said.get("tunable")), said.get("to"))


def _unsafe(setup: Setup, seen: Observation, operation: Operation) -> Sequence[Diagnostic]:
    from pico.policy.judging.case import PlanCase
    from pico.policy.judging.judges import judgment_of

    plan = _plan(setup, seen, operation, seen.backend, "")
    return judgment_of("beams", PlanCase(setup, plan, seen)).refusals


async def uncommissioned(
    setup: Setup, place: BenchPlace, able: Capabilities, device: Device, now: str
) -> tuple[str, ...]:  # fmt: skip
    """Return in words why lasers above class 2 stay shut on a bench that a person must have commissioned; empty where
    one has, or nothing of the sort is asked for. Raises PicoError for instruments that do not answer."""
    if not isinstance(device, Commissioned) or arming.waived(setup, able.evidence):
        return ()
    basis = await device.basis()
    try:
        report = read(place.root, able.name)
    except PicoError as exc:
        return (exc.diagnostics[0].summary,)
    return commissioning.why_not(report, able.name, basis, now, calibration_digest(place.root, able.name) or "")


async def require_commissioned(setup: Setup, place: BenchPlace, device: Device, now: str, given: Arming) -> None:
    """Raise PicoError (exit code DENIED) where an arming above class 2 needs a bench that is commissioned."""
    able = await device.describe()
    if above_class_2(given.laser_class) and (why := await uncommissioned(setup, place, able, device, now)):
        raise PicoError(commissioning.refusal(able.name, given.laser, why), ExitCode.DENIED)


def unended(setup: Setup, able: Capabilities, device: Device) -> frozenset[str]:
    """Return the lasers whose light nothing ends once PICO is dead or frozen: no dead-man, and no interlock that is
    wired past every computer; none on a bench where nothing is emitted."""
    if not isinstance(device, LightGuarded) or arming.waived(setup, able.evidence):
        return frozenset()
    if setup.lab.policy.hard_wired_interlock:
        return frozenset()
    return frozenset(arming.lasers(setup)) - device.dark_by_itself()


async def require_ended(setup: Setup, device: Device, given: Arming) -> None:
    """Raise PicoError (exit code DENIED) for an arming above class 2 of a laser whose light nothing would end."""
    able = await device.describe()
    if above_class_2(given.laser_class) and given.laser in unended(setup, able, device):
        name = given.laser
        text = f"{name} is not armed for class {given.laser_class}: nothing would end its light if PICO were killed or "
        detail = (
            f"to wire: the doors and the emergency stop of the table in series, through the interlock input of {name} "
        )
        detail += "or the supply of its shutter, so that opening one ends its light with every computer switched off"
        has_shutter = "shutter" in setup.type_of(name).tunables
        what, driver = ("its shutter", "switches.shutter") if has_shutter else ("its head", "switches.laser")
        hint = f"then say `policy: {{hard_wired_interlock: true}}` in lab.yaml; or give {what} a dead-man, "
        hint += f"`settings: {{watchdog: 1}}` with the driver `{driver}`"
        raise PicoError(error(DEAD_MAN, f"{text}this computer froze", detail=detail, hint=hint), ExitCode.DENIED)


async def with_licences(
    setup: Setup, place: BenchPlace, able: Capabilities, device: Device, now: str, seen: Observation
) -> Observation:  # fmt: skip
    """Return the observation with what lets lasers emit now."""
    known = [one.arming for one in armings.kept(place) if one.arming is not None]
    for one in known:
        if not one.seen_over and arming.at_its_end(one, now):
            with suppress(PicoError, OSError):  # a clock that is set back must not bring it back
                armings.keep(place, replace(one, seen_over=True))
    found = arming.licences(setup, able.evidence, known, able.name, now)
    if any(above_class_2(one.laser_class) and one.by for one in found.values()) and (
        why := await uncommissioned(setup, place, able, device, now)
    ):
        said = f"the bench is not commissioned: {why[0]}"
        found = {name: replace(one, laser_class="2", withheld=said) for name, one in found.items()}
    bare = unended(setup, able, device)
    without = "nothing would end its light if PICO were killed: it has no dead-man and no hard-wired interlock"
    found = {
        name: replace(one, laser_class="2", withheld=without)
        if name in bare and one.by and above_class_2(one.laser_class)
        else one
        for name, one in found.items()
    }
    return replace(seen, licences=found)


def over(setup: Setup, place: BenchPlace, now: str) -> dict[str, str]:
    """Return the lasers whose arming is over or broken, each with why."""
    found = {}
    for one in armings.kept(place):
        why = arming.over(setup, one.arming, now) if one.arming else f"its arming can't be read ({one.broken})"
        if why:
            found[one.laser] = why
    return found


def disarm_all(setup: Setup, place: BenchPlace, by: str, now: str) -> tuple[str, ...]:
    """End what arms lasers above class 2, also what has not begun, on behalf of `by`, and return of which. An arming
    that can't be kept as ended, for the disk is full, is forgotten."""
    found = []
    for one in armings.kept(place):
        given = one.arming
        if given is None or not above_class_2(given.laser_class) or arming.over(setup, given, now):
            continue
        try:
            armings.keep(place, arming.ended(setup, given, one.laser, by, given.backend, now))
        except (PicoError, OSError):
            with suppress(PicoError, OSError):
                armings.forget(place, one.laser)
        found.append(one.laser)
    return tuple(found)


def unlicensed(setup: Setup, seen: Observation) -> dict[str, str]:
    """Return the lasers that may shine and have no licence for the class that they are of, each with why: somebody took
    the waiver out of the Lab, another laser is in the housing, a clock was set back."""
    found = {}
    for laser in arming.lasers(setup):
        values = seen.known_values.get(laser, {})
        of = laser_class(setup, laser, values)[0]
        if may_shine(setup, seen, laser, values) and not licensed(seen, laser, of):
            found[laser] = f"it is of class {of}, and {why_not(seen, laser, of)}"
    return found


def shutting(setup: Setup, seen: Observation, laser: str, why: str) -> Operation | None:
    """Return the operation that shuts a laser: by its own shutter, else one in its beam, else it is switched off. None
    where it is dark, or is not there; ids are given by who runs it."""
    if laser not in setup.lab.inventory or not may_shine(setup, seen, laser, seen.known_values.get(laser, {})):
        return None
    gate = laser if "shutter" in setup.type_of(laser).tunables else shutter_of(setup, seen, (), laser)
    component, tunable = (gate, "shutter") if gate else (laser, "emission")
    if seen.known_values.get(component, {}).get(tunable) in ("closed", False):
        return None
    before = seen.known_values.get(component, {}).get(tunable)
    return Operation(
        id=f"shut_{laser}", primitive="set", component=component, reason=Reason(kind="interlock", text=why),
        arguments={"tunable": tunable, "from": before, "to": "closed" if gate else False},
        resources=(f"{component}.{tunable}", component),
    )  # fmt: skip


def shut_plan(setup: Setup, seen: Observation, operation: Operation, able: Capabilities) -> Plan:
    """Return a plan that shuts a laser, as the journal keeps it: it tidies up, and is nothing to undo."""
    return _plan(setup, seen, operation, able.name, able.fidelity)


def dark_plan(setup: Setup, seen: Observation, operations: Sequence[Operation], able: Capabilities, title: str) -> Plan:
    """Return a plan that ended light beside any run, as the journal keeps it: it tidies up, and is nothing to undo."""
    return _planned(setup, seen, operations, able.name, able.fidelity, title)


def _plan(setup: Setup, seen: Observation, operation: Operation, backend: str, fidelity: str) -> Plan:
    title = f"{operation.component} shut: {operation.reason.text}"
    return _planned(setup, seen, [operation], backend, fidelity, title)


def _planned(
    setup: Setup, seen: Observation, operations: Sequence[Operation], backend: str, fidelity: str, title: str
) -> Plan:  # fmt: skip
    state = live_state(setup, seen).as_json()
    return Plan(
        lab=LabRef(name=setup.lab.name, digest=setup.digest()), backend=backend, fidelity=fidelity,
        base=Base(state=state), target=Target(title=title, cause="recover", state=state), operations=tuple(operations),
    ).sealed()  # fmt: skip


def told(laser: str, why: str) -> Diagnostic:
    """Return what is said of a laser that was shut because its arming is over."""
    return warning(UNARMED, f"{laser} was shut: {why}", hint=f"`pico laser arm {laser}` opens it again", address=laser)
