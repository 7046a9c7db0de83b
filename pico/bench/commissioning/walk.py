"""A commissioning from its first step to its report: what comes next, what is kept, what makes it begin anew."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any, Literal

from pico.backends.devices import EMULATED, HARDWARE
from pico.backends.hardware.device import HardwareDevice
from pico.backends.hardware.report import read, write
from pico.base import clock
from pico.bench.bench import Bench
from pico.bench.commissioning.instruments import devices, identities
from pico.bench.commissioning.placing import pick_and_place
from pico.bench.commissioning.pulling import safety_inputs
from pico.bench.commissioning.reaching import reach
from pico.bench.commissioning.seeing import calibration, drift
from pico.bench.commissioning.standing import HOURS, REPEATS, Asking, AtBench, Declined, Found
from pico.bench.commissioning.swinging import first_move, stop_distance
from pico.bench.commissioning.trying import motion
from pico.bench.lasers import person_of
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.edge.local import LocalEdge
from pico.model.commissioning import BEFORE, CODE, DAYS, FILES, STEPS, Basis, Commissioning, Step, StepResult, changed
from pico.model.record import record
from pico.places.bench import BenchPlace
from pico.policy.commissioning import recalibrated, until, why_not
from pico.vision.calibration_files import calibration_digest

DOING: Mapping[Step, Callable[[AtBench], Found]] = {
    "devices": devices, "identities": identities, "calibration": calibration, "reach": reach, "motion": motion,
    "first_move": first_move, "stop_distance": stop_distance, "safety_inputs": safety_inputs,
    "pick_and_place": pick_and_place, "drift": drift,
}  # fmt: skip
"""What each step does: its first line says what passes."""


@record
class Standing:
    """How a commissioning stands: its report, and in words why that does not count (`why`); `until`: when it is too old
    (ISO 8601)."""

    bench: str
    file: str
    report: Commissioning | None
    why: tuple[str, ...] = ()
    until: str = ""


@record
class Done:
    """A step that was done now: what became of it, and what went wrong."""

    step: Step
    result: StepResult
    diagnostics: tuple[Diagnostic, ...] = ()


def standing_by_file(bench: Bench) -> Standing | None:
    """Return how the commissioning of a bench that another process serves stands by its report alone, for that process
    has its devices; None for a bench that is not served so, or has none to be asked."""
    name, place = bench.backend_name, bench.place
    if name not in (HARDWARE, EMULATED) or not isinstance(place, BenchPlace) or isinstance(bench.edge, LocalEdge):
        return None
    kind: Literal["hardware", "emulated"] = "emulated" if name == EMULATED else "hardware"
    report = read(place.root, kind)
    of_then, known = report.basis if report else Basis(wired="", bench=""), calibration_digest(place.root, kind) or ""
    why = why_not(report, kind, of_then, clock.now(), known)
    return _standing(kind, report, why)


def _standing(name: Literal["hardware", "emulated"], report: Commissioning | None, why: tuple[str, ...]) -> Standing:
    ends = until(report) if report else None
    said = clock.as_text(ends) if ends else ""
    return Standing(bench=name, file=FILES[name], report=report, why=why, until=said)


class Walk:
    """The commissioning of one bench. Raises PicoError where that bench is none to be commissioned."""

    def __init__(self, bench: Bench, asks: Asking, *, repeats: int = REPEATS, hours: float = HOURS) -> None:
        self.bench, self.asks, self.repeats, self.hours = bench, asks, repeats, hours
        edge = bench.edge
        if not isinstance(edge, LocalEdge):
            text = "the bench is served by another process, and a commissioning asks its instruments itself"
            hint = "beside the table, in the lab's folder there, once `pico edge` has been ended"
            raise PicoError(error(CODE, text, hint=hint), ExitCode.LOCKED)
        if not isinstance(edge.device, HardwareDevice):
            text = "nothing of a simulated bench has to be commissioned"
            raise PicoError(error(CODE, text, hint="`--backend hardware`; with `--emulate` to try it"))
        self.edge, self.device = edge, edge.device

    @property
    def name(self) -> Literal["hardware", "emulated"]:
        """Which bench of the lab it is."""
        return "emulated" if self.device.bench == EMULATED else "hardware"

    def standing(self) -> Standing:
        """Return how it stands; asks the devices who they are, and moves nothing."""
        report = read(self.edge.place.root, self.name)
        try:
            why = why_not(report, self.name, self._basis(), self.edge.now(), self._calibration())
        except PicoError as exc:
            of_then = report.basis if report else Basis(wired="", bench="")
            more = f" ({len(exc.diagnostics)} in all)" if len(exc.diagnostics) > 1 else ""
            known = why_not(report, self.name, of_then, self.edge.now(), self._calibration())
            why = (*known, f"{exc.diagnostics[0].summary}{more}")
        return _standing(self.name, report, why)

    def todo(self) -> tuple[Step, ...]:
        """Return the steps that are still to be done, or again."""
        report, basis = read(self.edge.place.root, self.name), self._basis()
        if report is None or report.bench != self.name or changed(report, basis):
            return STEPS
        now = self.edge.now()
        other = {"calibration"} if any(recalibrated(report, self._calibration())) else set()
        return tuple(s for s in STEPS if not report.passed(s) or s in other or _too_old(report, s, now))

    def walk(self, steps: tuple[Step, ...], days: float | None = None) -> Iterator[Done]:
        """Do steps, keep what each finds, and yield it; ends with the first that fails. What was found of another bench
        than this is now is left, which is told. Raises PicoError where a step can't be done now, or nobody can be
        asked; Declined where somebody says no."""
        report = self._begun(days)
        for step in steps:
            missing = [before for before in BEFORE.get(step, ()) if not report.passed(before)]
            if missing:
                text = f"{step} comes after {', '.join(missing)}, which did not pass yet"
                raise PicoError(error(CODE, text, hint=f"`pico commission --only {missing[0]}`"))
            done, report = self._done(step, report)
            yield done
            if done.result.outcome == "failed":
                return

    def _begun(self, days: float | None) -> Commissioning:
        """Return the report to go on with."""
        report, basis = read(self.edge.place.root, self.name), self._basis()
        if report is None or report.bench != self.name or report.lab != self.edge.setup.lab.name:
            return Commissioning(lab=self.edge.setup.lab.name, bench=self.name, basis=basis, days=days or DAYS)
        if other := changed(report, basis):
            self.asks.say(f"This is another bench than it was: {'; '.join(other)}. All steps are to be done again.")
            report = replace(report, basis=basis, steps={})
        return replace(report, days=days or report.days)

    def _done(self, step: Step, report: Commissioning) -> tuple[Done, Commissioning]:
        """Do a step and keep what it found; while it goes on it counts as begun, so that tools are slow."""
        known = report.steps.get(step)
        before: Mapping[str, Any] = known.data if known and known.outcome == "begun" else {}
        kept = [report]

        def keep(found: Found, outcome: Literal["passed", "failed", "begun"] = "begun") -> StepResult:
            by = person_of(self.bench) or "nobody named"
            made = StepResult(outcome=outcome, at=self.edge.now(), by=by, told=found.told, data=found.data)
            kept[0] = replace(report, steps={**report.steps, step: made})
            write(self.edge.place.root, kept[0])
            return made

        keep(Found(told="begun", data=before))
        at = AtBench(
            bench=self.bench, edge=self.edge, device=self.device, asks=self.asks, keep=lambda found: _none(keep(found)),
            before=before, repeats=self.repeats, hours=self.hours,
        )  # fmt: skip
        try:
            found = DOING[step](at)
        except PicoError as exc:
            if isinstance(exc, Declined) or exc.exit_code == ExitCode.LOCKED or exc.diagnostics[0].code == "usage":
                write(self.edge.place.root, report)  # it says nothing of the bench
                raise
            last = kept[0].steps[step].data
            made = keep(Found(told=exc.diagnostics[0].summary, data=last), "failed")
            return Done(step=step, result=made, diagnostics=tuple(exc.diagnostics)), kept[0]
        return Done(step=step, result=keep(found, "begun" if found.begun else "passed")), kept[0]

    def _calibration(self) -> str:
        return calibration_digest(self.edge.place.root, self.name) or ""

    def _basis(self) -> Basis:
        return self.bench.wait(self.device.basis())


def _none(_: object) -> None:
    return None


def _too_old(report: Commissioning, step: Step, now: str) -> bool:
    alone = replace(report, steps=dict.fromkeys(STEPS, report.steps[step]))
    return bool(why_not(alone, report.bench, report.basis, now))
