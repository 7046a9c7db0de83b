"""The check of a morning: what a bench's light has done since it was good, and which part that tells of.

The arm stays parked; motors go to a few set-points and back. What is read is compared with the reference: the last
morning that somebody accepted, of the bench as it stands now.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pico.base import clock
from pico.bench.drifting.morning import Morning, Moved, Read, Survey
from pico.bench.drifting.readings import DARK, readings_of
from pico.bench.drifting.references import Reference, keep, reference_for
from pico.bench.opened import Opened
from pico.bench.plans import Plans
from pico.diagnosis.quantities import Quantity, Shot
from pico.diagnostics import ExitCode, PicoError, error
from pico.edge.emission import unlicensed
from pico.model.plan import UNARMED

if TYPE_CHECKING:
    from pico.diagnosis.nominal import Nominal
    from pico.model.observation import Observation
    from pico.model.plan import Plan
    from pico.model.trace.event import Event
    from pico.model.trace.report import RunReport
    from pico.runs.journal import JournalRecord

LONGEST = 180.0
"""What a morning may take of a bench [s]; scans that would take longer are left out, the last first."""


class Mornings:
    """Mornings of one bench."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened
        self._nominals: dict[str, Nominal] = {}

    def survey(self, *, accept: bool = False) -> Survey:
        """Return what is going to be read; `accept`: for a new reference. Raises PicoError where that can't be."""
        from pico.bench.drifting.expected import as_known
        from pico.diagnosis.choosing import chosen, darks

        opened, seen = self.opened, self.opened.observe()
        if bare := unlicensed(opened.setup, seen):
            laser, why = next(iter(bare.items()))
            text = f"{laser} shines, and must not: {why}"
            hint = f"`pico laser disarm {laser}` shuts it; `pico laser arm {laser}` lets it shine"
            raise PicoError(error(UNARMED, text, hint=hint, address=laser), ExitCode.DENIED)
        nominal = then = self._nominal(seen)
        cameras = tuple(n for n in sorted(nominal.poses) if "dark" in opened.setup.measurables_of(n))
        reference, moved = reference_for(opened.place, nominal)
        if reference and moved:
            then, nominal = as_known(nominal, reference, moved)
        before = () if reference is None or (moved and accept) else reference.quantities
        what = nominal.kept("chosen", repr(before), lambda: chosen(nominal, before))
        quantities = before or (*what.quantities, *darks(nominal, cameras))
        if not quantities:
            hint = "; ".join(what.lacks) or "no detector stands in a beam"
            raise PicoError(error("morning", "nothing of this bench tells how its light is", hint=hint))
        quantities, gone = _there(seen, quantities)
        found, lacks = self._ahead(seen, quantities), (*what.lacks, *gone)
        if found[0].exit_code and (wrong := self._refused(seen, quantities)):
            quantities = tuple(q for q in quantities if q.name not in wrong)
            found, lacks = self._ahead(seen, quantities), (*lacks, *filter(None, wrong.values()))
        while sum(op.seconds for op in found[0].operations) > LONGEST:
            longest = next((q for q in reversed(quantities) if len(q.shots) > 1), None)
            if longest is None:
                break
            keys = {shot.key for shot in longest.shots}
            quantities = tuple(q for q in quantities if not q.tunable or keys.isdisjoint(s.key for s in q.shots))
            lacks = (*lacks, f"{longest.name} would be read, were a morning longer than {LONGEST:.0f} s")
            found = self._ahead(seen, quantities)
        plan, shots, dark = found
        what = replace(what, lacks=lacks)
        return Survey(plan, nominal, what, quantities, shots, dark, seen, then, reference, moved, accept)

    def _refused(self, seen: Observation, quantities: Sequence[Quantity]) -> dict[str, str]:
        """Return the scans that a plan may not make, with why: on the way to a null light may be too bright for what
        comes next."""
        scans: dict[tuple[str, ...], list[Quantity]] = {}
        for one in (q for q in quantities if len(q.shots) > 1):
            scans.setdefault(tuple(shot.key for shot in one.shots), []).append(one)
        wrong = dict[str, str]()
        for same in scans.values():
            if (plan := self._ahead(seen, same)[0]).exit_code:
                why = next(d.summary for d in plan.diagnostics if d.severity == "error")
                wrong |= {q.name: f"{q.name} would be read, were the way there safe: {why}" for q in same}
                shots = {shot.key for shot in same[0].shots}
                wrong |= {q.name: "" for q in quantities if len(q.shots) == 1 and q.shots[0].key in shots}
        return wrong

    def _ahead(
        self, seen: Observation, quantities: Sequence[Quantity]
    ) -> tuple[Plan, tuple[Shot, ...], tuple[str, ...]]:
        """Return the plan of reading some quantities, its shots, and what it takes frames in the dark of."""
        every = tuple({s.key: s for q in quantities for s in q.shots}.values())
        shots = tuple(s for s in every if not s.address.endswith(DARK))
        dark = tuple(s.address for s in every if s.address.endswith(DARK))
        cameras = [d.partition(".")[0] for d in dark]
        return Plans(self.opened).to_survey(seen, [(s.address, s.at) for s in shots], cameras), shots, dark

    def read(
        self, survey: Survey, show: Callable[[Event], None] = lambda _: None,
        say: Callable[[str], None] = lambda _: None, *, came: list[int] | None = None,
    ) -> tuple[RunReport, Morning]:  # fmt: skip
        """Run a survey and judge what was read. `show` gets each event; a signal ends it, and sets all back, and is put
        into `came`."""
        from pico.bench.moves import Moves
        from pico.bench.running.attending import attend

        run, events = Moves(self.opened).run(survey.plan, holder="pico morning"), list[Any]()

        def heard(event: Event) -> None:
            events.append(event)
            show(event)

        signals = attend(run, heard, say)
        if came is not None:
            came += signals
        return run.report, self.judged(survey, run.report, events)

    def judged(self, survey: Survey, report: RunReport, events: Sequence[Event]) -> Morning:
        """Return what the run of a survey tells."""
        from pico.bench.drifting.judging import compared

        setup = self.opened.setup
        steady = {n: (setup.type_of(n).number("uncertainty", "") or 0.0) / 2 for n in setup.lab.inventory}
        read = readings_of(self.opened.folder.root, survey.shots, survey.dark, report, events, steady)
        got = tuple(read.got(q) for q in survey.quantities)
        took = sum(e.data.get("seconds") or 0.0 for e in events if e.kind == "operation_done")
        found = Morning(
            report.run or "", clock.now(), took, lacks=survey.chosen.lacks, cut_short=read.cut_short,
            set_back=_set_back(survey, events),
        )  # fmt: skip
        found = compared(survey, found, read, got, self._records(survey))
        lit = bool(survey.chosen.quantities) and any(got)
        if survey.accept and lit and not read.cut_short:
            seen = self._nominal(survey.seen)
            keep(self.opened.place, Reference(found.at, found.run, seen.poses, seen.values, survey.quantities, got))
            found = replace(found, accepted=True)
        return found

    def _records(self, survey: Survey) -> Sequence[JournalRecord]:
        """Return what the journal has of what stands or is set otherwise; nothing where it can't be read."""
        try:
            return memory.records() if survey.moved and (memory := self.opened.edge.memory) else ()
        except PicoError:
            return ()

    def _nominal(self, seen: Observation) -> Nominal:
        """Return the ray model of the bench as it was seen; the last one is kept with what it has traced."""
        from pico.diagnosis.recorded import nominal_of

        found = nominal_of(self.opened.setup, seen)
        poses, values = found.poses, found.values
        key = repr((sorted(poses.items()), sorted((n, sorted(v.items())) for n, v in values.items())))
        if key not in self._nominals:
            self._nominals = {key: found}
        return self._nominals[key]


def _there(seen: Observation, quantities: Sequence[Quantity]) -> tuple[tuple[Quantity, ...], tuple[str, ...]]:
    """Return the quantities of whose shots all parts are on the table, and why the others are not read."""
    gone = {n for n, part in seen.components.items() if part.presence != "seen"}
    parts = [{a.partition(".")[0] for s in q.shots for a in (s.address, *s.at)} & gone for q in quantities]
    left = {name: [q.name for q, own in zip(quantities, parts, strict=True) if name in own] for name in sorted(gone)}
    why = (f"{', '.join(names)} would be read, were {name} on the table" for name, names in left.items() if names)
    return tuple(q for q, own in zip(quantities, parts, strict=True) if not own), tuple(why)


_BEGAN = ("operation_started", "operation_done", "operation_failed", "operation_unknown")


def _set_back(survey: Survey, events: Sequence[Event]) -> bool:
    """Return whether what a survey set is known to stand where it stood."""
    began = {op.id: op.arguments["from"] for op in survey.plan.operations if op.primitive == "survey"}
    told = [e for e in events if e.operation in began and e.kind in _BEGAN]
    return not told or told[-1].data.get("last") == began[told[-1].operation or ""]


__all__ = ["Morning", "Mornings", "Moved", "Read", "Survey"]
