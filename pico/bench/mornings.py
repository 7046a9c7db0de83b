"""The check of a morning: what a bench's light has done since it was good, and which part that tells of.

The arm stays parked; motors go to a few set-points and back. What is read is compared with the reference: the last
morning that somebody accepted, of the bench as it stands now.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from typing import TYPE_CHECKING, Any

from pico.bench.drifting.readings import DARK, NOT_ASKED, Readings, readings_of
from pico.bench.drifting.references import Reference, keep, reference_for
from pico.bench.opened import Opened
from pico.bench.plans import Plans
from pico.diagnosis.quantities import Got, Quantity, Shot
from pico.diagnostics import ExitCode, PicoError, error
from pico.edge.emission import unlicensed
from pico.edge.lease import utc_now
from pico.model.plan import UNARMED

if TYPE_CHECKING:
    from pico.diagnosis.choosing import Chosen
    from pico.diagnosis.nominal import Nominal
    from pico.diagnosis.suspects import Suspect, Verdict
    from pico.model.observation import Observation
    from pico.model.plan import Plan
    from pico.model.trace.event import Event
    from pico.model.trace.report import RunReport

LONGEST = 180.0
"""What a morning may take of a bench [s]; scans that would take longer are left out, the last first."""
UNUSUAL = 0.5
"""The probability that something happened from which a morning says so."""


@dataclass(frozen=True)
class Read:
    """One quantity of a morning: `then` and `now` in its coordinate (a logarithm for a share, see `law`), one standard
    deviation of what was read now, and the `change` in those of what is usual from day to day; `unknown`: why it could
    not be read."""

    name: str
    law: str
    unit: str
    then: float | None
    now: float | None
    sigma: float | None
    change: float | None = None
    unknown: str = ""


@dataclass(frozen=True)
class Morning:
    """What a morning found, in a `run` that took `seconds` of the bench. `reference`: when what it is compared with was
    read, empty where there was nothing, and its `age` [s]; `why`: why there was none. `unusual`: whether something
    happened; `repair`: the shortest, in words. `accepted`: it is the reference from now on. `set_back`: whether all
    that was set for it is known to stand where it stood."""

    run: str
    at: str
    seconds: float
    reference: str = ""
    age: float = 0.0
    why: str = ""
    readings: tuple[Read, ...] = ()
    suspects: tuple[Suspect, ...] = ()
    unusual: bool = False
    repair: str = ""
    lacks: tuple[str, ...] = ()
    cut_short: bool = False
    accepted: bool = False
    set_back: bool = True


@dataclass(frozen=True, eq=False)
class Survey:
    """What a morning is going to read: `quantities` of `shots` and of frames in the `dark`, by the `plan`."""

    plan: Plan
    nominal: Nominal
    chosen: Chosen
    quantities: tuple[Quantity, ...]
    shots: tuple[Shot, ...]
    dark: tuple[str, ...]
    reference: Reference | None = None
    why: str = ""


class Mornings:
    """Mornings of one bench."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened
        self._nominals: dict[str, Nominal] = {}

    def survey(self) -> Survey:
        """Return what is going to be read; raises PicoError where that can't be."""
        from pico.diagnosis.choosing import chosen, darks

        opened, seen = self.opened, self.opened.observe()
        if bare := unlicensed(opened.setup, seen):
            laser, why = next(iter(bare.items()))
            text = f"{laser} shines, and must not: {why}"
            hint = f"`pico laser disarm {laser}` shuts it; `pico laser arm {laser}` lets it shine"
            raise PicoError(error(UNARMED, text, hint=hint, address=laser), ExitCode.DENIED)
        nominal = self._nominal(seen)
        cameras = tuple(n for n in sorted(nominal.poses) if "dark" in opened.setup.measurables_of(n))
        reference, why = reference_for(opened.place, nominal)
        before = reference.quantities if reference else ()
        what = nominal.kept("chosen", repr(before), lambda: chosen(nominal, before))
        quantities = reference.quantities if reference else (*what.quantities, *darks(nominal, cameras))
        if not quantities:
            hint = "; ".join(what.lacks) or "no detector stands in a beam"
            raise PicoError(error("morning", "nothing of this bench tells how its light is", hint=hint))
        found, lacks = self._ahead(seen, quantities), what.lacks
        if found[0].exit_code and (wrong := self._refused(seen, quantities)):
            quantities = tuple(q for q in quantities if q.name not in wrong)
            found, lacks = self._ahead(seen, quantities), (*lacks, *wrong.values())
        while sum(op.seconds for op in found[0].operations) > LONGEST:
            longest = next((q for q in reversed(quantities) if q.tunable), None)
            if longest is None:
                break
            quantities = tuple(q for q in quantities if q.shots != longest.shots)
            lacks = (*lacks, f"{longest.name} would be read, were a morning longer than {LONGEST:.0f} s")
            found = self._ahead(seen, quantities)
        plan, shots, dark = found
        return Survey(plan, nominal, replace(what, lacks=lacks), quantities, shots, dark, reference, why)

    def _refused(self, seen: Observation, quantities: Sequence[Quantity]) -> dict[str, str]:
        """Return the scans that a plan may not make, with why: on the way to a null light may be too bright for what
        comes next."""
        scans: dict[tuple[str, ...], list[Quantity]] = {}
        for one in (q for q in quantities if q.tunable):
            scans.setdefault(tuple(shot.key for shot in one.shots), []).append(one)
        wrong = dict[str, str]()
        for same in scans.values():
            if (plan := self._ahead(seen, same)[0]).exit_code:
                why = next(d.summary for d in plan.diagnostics if d.severity == "error")
                wrong |= {q.name: f"{q.name} would be read, were the way there safe: {why}" for q in same}
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
        say: Callable[[str], None] = lambda _: None, *, accept: bool = False, came: list[int] | None = None,
    ) -> tuple[RunReport, Morning]:  # fmt: skip
        """Run a survey and judge what was read. `show` gets each event; a signal ends it, and sets all back, and is put
        into `came`. `accept`: this morning is the reference from now on."""
        from pico.bench.moves import Moves
        from pico.bench.running.attending import attend

        run, events = Moves(self.opened).run(survey.plan, holder="pico morning"), list[Any]()

        def heard(event: Event) -> None:
            events.append(event)
            show(event)

        signals = attend(run, heard, say)
        if came is not None:
            came += signals
        return run.report, self.judged(survey, run.report, events, accept=accept)

    def judged(self, survey: Survey, report: RunReport, events: Sequence[Event], *, accept: bool = False) -> Morning:
        """Return what the run of a survey tells."""
        root = self.opened.folder.root
        read = readings_of(root, survey.shots, survey.dark, report, events)
        got = tuple(read.got(q) for q in survey.quantities)
        took = sum(e.data.get("seconds") or 0.0 for e in events if e.kind == "operation_done")
        found = Morning(
            report.run or "", utc_now(), took, lacks=survey.chosen.lacks, cut_short=read.cut_short, why=survey.why,
            set_back=_set_back(survey, events),
        )  # fmt: skip
        found = self._compared(survey, survey.reference, found, read, got)
        lit = bool(survey.chosen.quantities) and any(got)
        if lit and not read.cut_short and (accept or survey.reference is None):
            nominal = survey.nominal
            keep(
                self.opened.place, Reference(found.at, found.run, nominal.poses, nominal.values, survey.quantities, got)
            )
            found = replace(found, accepted=True)
        return found

    def _compared(
        self, survey: Survey, reference: Reference | None, found: Morning, read: Readings, got: Sequence[Got | None]
    ) -> Morning:  # fmt: skip
        """Return a morning with its readings beside those of a reference, and who is suspected; of one that was cut
        short nothing is judged."""
        from pico.diagnosis.repairs import repair, unread
        from pico.diagnosis.suspects import NOTHING

        then = reference.got if reference else (None,) * len(got)
        verdict = self._verdict(survey, then, got) if reference and not read.cut_short else None
        changes = list(verdict.changes) if verdict else []
        reads = tuple(
            _read(q, a, b, changes.pop(0) if verdict and a and b else math.nan, read.why(q))
            for q, a, b in zip(survey.quantities, then, got, strict=True)
        )
        if reference is None or read.cut_short:
            return replace(found, readings=reads)
        lost = [q.shots[0].address for q, r in zip(survey.quantities, reads, strict=True)
                if r.then is not None and r.now is None and r.unknown != NOT_ASKED]  # fmt: skip
        suspects = _darkened(survey, read, then, got) or (verdict.suspects if verdict else ())
        changed = sum(s.probability for s in suspects if s.kind != NOTHING) > UNUSUAL
        first = next((s for s in suspects if s.kind != NOTHING), None) if changed else None
        how = repair(self.opened.setup, first, survey.nominal.values) if first else unread(lost[0]) if lost else ""
        return replace(
            found, reference=reference.at, age=_age(reference.at, found.at), readings=reads, suspects=suspects,
            unusual=changed or bool(lost), repair=how,
        )  # fmt: skip

    def _verdict(
        self, survey: Survey, then: Sequence[Got | None], got: Sequence[Got | None]
    ) -> Verdict | None:  # fmt: skip
        from pico.diagnosis.causes import causes
        from pico.diagnosis.suspects import Compared, suspects

        both = zip(survey.quantities, then, got, strict=True)
        compared = [Compared(q, a, b) for q, a, b in both if a is not None and b is not None]
        read = sorted({s.address.partition(".")[0] for q in survey.quantities for s in q.shots})
        parts = tuple(dict.fromkeys((*survey.chosen.parts, *read)))
        return suspects(survey.nominal, compared, causes(self.opened.setup, parts)) if compared else None

    def _nominal(self, seen: Observation) -> Nominal:
        """Return the ray model of the bench as it was seen; the last one is kept with what it has traced."""
        from pico.diagnosis.recorded import nominal_of

        found = nominal_of(self.opened.setup, seen)
        poses, values = found.poses, found.values
        key = repr((sorted(poses.items()), sorted((n, sorted(v.items())) for n, v in values.items())))
        if key not in self._nominals:
            self._nominals = {key: found}
        return self._nominals[key]


_BEGAN = ("operation_started", "operation_done", "operation_failed", "operation_unknown")


def _set_back(survey: Survey, events: Sequence[Event]) -> bool:
    """Return whether what a survey set is known to stand where it stood."""
    began = {op.id: op.arguments["from"] for op in survey.plan.operations if op.primitive == "survey"}
    told = [e for e in events if e.operation in began and e.kind in _BEGAN]
    return not told or told[-1].data.get("last") == began[told[-1].operation or ""]


def _darkened(
    survey: Survey, read: Readings, then: Sequence[Got | None], got: Sequence[Got | None]
) -> tuple[Suspect, ...]:  # fmt: skip
    """Return what keeps the light from detectors that read a power with all as it stands, and see none now."""
    from pico.diagnosis.darkness import darkened

    dark, lit, monitors = set[str](), set[str](), dict[str, float]()
    for one, before, now in zip(survey.quantities, then, got, strict=True):
        component, _, measurable = one.shots[0].address.partition(".")
        if one.law != "share" or len(one.shots) > 1 or before is None or measurable == "dark":
            continue
        if measurable == "monitor":
            monitors[component] = now.value - before.value if now else 0.0
        elif not any(not a.endswith(".exposure") for a in one.shots[0].at):
            (dark if read.dark(one) else lit).add(component)
    return darkened(survey.nominal, dark, lit - dark, monitors) if dark else ()


def _read(wanted: Quantity, then: Got | None, now: Got | None, change: float, why: str) -> Read:
    return Read(
        wanted.name, wanted.law, wanted.unit, then.value if then else None, now.value if now else None,
        now.sigma if now else None, None if math.isnan(change) else change, "" if now else why,
    )  # fmt: skip


def _age(then: str, now: str) -> float:
    return (datetime.fromisoformat(now) - datetime.fromisoformat(then)).total_seconds()
