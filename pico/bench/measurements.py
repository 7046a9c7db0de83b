"""What the bench shows now: its parts, their values, and whether it stands and reads as somebody expects."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.bench.opened import Opened
from pico.diagnostics import Diagnostic, PicoError, warning
from pico.kernels.pipeline import source_of
from pico.model.comparing.drift import drift_of
from pico.model.diff import unread_values
from pico.model.plan import Plan
from pico.model.request import read_peeked, read_values

if TYPE_CHECKING:
    from pico.model.catalog import ComponentType
    from pico.model.goal import Goal
    from pico.model.measurement import Measurement
    from pico.model.trace.expectation import GoalRead, Verified
    from pico.model.trace.report import PartRow, RunReport
    from pico.runs.memory import Memory

NOISE = 3.0
"""So many standard deviations a reading may be from zero and still be noise."""


@dataclass(frozen=True)
class Verification:
    """What is to be measured, by the `plan` (without operations where that is nothing), and goals of which it can be
    told without (`told`)."""

    plan: Plan
    told: tuple[GoalRead, ...] = ()


class Measurements:
    """What is read off one bench. Nothing moves by it, and nothing is recorded."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened

    def read(self, component: str, tunable: str | None = None) -> dict[str, dict[str, Any]]:
        """Return the tunables of a component as observed: `value`, `unit`, `status` of each; raises PicoError.

        A measurable, also of a camera over the bench, is peeked at: of its value nothing is assured.
        """
        opened = self.opened
        declared = opened.setup.measurables_of(component).get(tunable or "")
        if tunable and declared and declared.datatype in ("image", "float", "numbers"):
            return {tunable: read_peeked(opened.wait(opened.edge.peek(component, tunable)))}
        return read_values(opened.setup, opened.observe(), component, tunable)

    def picture(self, measurement: Measurement, out: Path) -> None:
        """Write the picture of a measurement as PNG, its brightest pixel white, its black level black; raises PicoError
        where there is none, or it can't be written."""
        from pico.bench.picturing.kept import as_picture
        from pico.content.arrays import load_array
        from pico.content.store import store_of
        from pico.diagnostics import PicoError, error
        from pico.drawing.picture import write_png

        if measurement.array is None or len(measurement.array.shape) != 2:
            name = measurement.component
            text = f"of {measurement.address} no picture was kept"
            raise PicoError(error("picture", text, hint=f"`pico measure {name}.image` keeps one", address=name))
        write_png(as_picture(load_array(store_of(self.opened.folder.root), measurement.array), measurement), out)

    def advice(self, found: Measurement) -> str:
        """Return what to do about a measurement without a value, or of too much light; empty where nothing is known."""
        setup = self.opened.setup
        if "not saturated" in found.not_assured:
            kind = setup.type_of(found.component) if found.component in setup.lab.inventory else None
            if kind and "auto_range" in kind.primitives and not _at_shortest(kind, found):
                return f"`pico do {found.component} auto_range` finds an exposure that suits"
            return "weaken the beam with a filter, or lower the gain"
        return self.dark() if found.unknown else ""

    def darkness(self, found: Measurement) -> Diagnostic | None:
        """Return why no light comes to a detector that reads none within its noise, as far as the bench says it."""
        from pico.planning.darkness import darkness, detects

        opened = self.opened
        if not detects(opened.setup, found.component) or found.measurable == "dark" or not _within_noise(found):
            return None
        reasons = darkness(opened.setup, opened.observe(), opened.folder.state_now(), found.component)
        if not reasons:
            return None
        text = f"no light reaches {found.component}: {', '.join(reasons)}"
        sources = [one.partition(".")[0].partition(" ")[0] for one in reasons]
        hint = "; ".join(self._arming(dict.fromkeys(sources))) or "`pico beam` shows where the light goes"
        return warning("dark", text, hint=hint, address=found.component)

    def dark(self) -> str:
        """Return what keeps light back on the bench, or where to see where it goes."""
        from pico.model.diff import show_value
        from pico.optics.ends import closures

        setup, known = self.opened.setup, self.opened.observe().known_values
        dark = [
            f"{name}.{tunable} is {show_value(value)}"
            for name in sorted(setup.lab.inventory)
            if setup.type_of(name).optics.element in ("source", "shutter")
            for tunable, value in closures(known.get(name, {}))
        ]
        opens = self._arming(dict.fromkeys(one.partition(".")[0] for one in dark))
        return "; ".join([", ".join(dark), *opens]) if dark else "`pico beam` shows where the light goes"

    def _arming(self, names: Iterable[str]) -> list[str]:
        """Return how those of some parts that are lasers nobody armed are opened."""
        from pico.optics.audit.lasers import laser_class
        from pico.planning.checks.emission import licensed

        setup, seen = self.opened.setup, self.opened.observe()
        known = seen.known_values
        sources = [n for n in names if n in setup.lab.inventory and setup.type_of(n).optics.element == "source"]
        unarmed = [n for n in sources if not licensed(seen, n, laser_class(setup, n, known.get(n, {}))[0])]
        return [f"`pico laser arm {name}` opens it" for name in unarmed]

    def _measurables(self) -> frozenset[str]:
        return self.opened.wait(self.opened.edge.describe()).measurables

    def parts(self, *, free: bool = False) -> tuple[PartRow, ...]:
        """Return the inventory with where each part is; `free`: only those that the manifest leaves in storage."""
        from pico.model.trace.report import parts_of

        return parts_of(self.opened.setup, self.opened.state, self.opened.observe(), free=free)

    def to_verify(self, revision: str | None = None) -> Verification:
        """Return what is to be measured to verify the bench against a revision, or the manifest, as far as it can
        measure that: goals where their tunables stand, what expectations speak of, and what a commit recorded; raises
        PicoError."""
        from pico.bench.light import Lights
        from pico.bench.plans import Plans
        from pico.model.vocabulary import measured_in
        from pico.planning.by_light import told_of
        from pico.planning.verifying import readable

        opened, setup, seen = self.opened, self.opened.setup, self.opened.observe()
        state = opened.folder.state_at(revision) if revision else opened.state
        able, recorded = self._measurables(), Lights(opened).recorded(revision)
        goals = {**(setup.lab.goals or {}), **told_of(setup, seen, state).goals}
        turns, told = readable(setup, seen, state, goals, self._when_met(goals, recorded.goals), able)
        spoken = measured_in(setup, [one.that for one in state.expect])
        light = [(one.component, one.measurable) for _, one in sorted(recorded.measured.items())]
        wanted = [one for one in dict.fromkeys((*spoken, *light)) if source_of(".".join(one)) in able]
        return Verification(Plans(opened).measuring(wanted, turns), told)

    def _when_met(
        self, goals: Mapping[str, Goal], recorded: Mapping[str, Mapping[str, float]]
    ) -> dict[str, Mapping[str, float]]:
        """Return what was measured when goals were met: in the runs of a commit, else last on this bench."""
        from pico.model.record import as_json
        from pico.runs.when_met import measured_when_met

        memory = self.opened.edge.memory
        own = {name: measured_when_met(memory, name, as_json(goals[name])) for name in goals.keys() - recorded.keys()}
        return {**recorded, **{name: last for name, last in own.items() if last is not None}}

    def _memory(self) -> Memory | None:
        """Return the memory of the bench, None if the journal is damaged: that hides nothing of what commits prove."""
        try:
            return self.opened.edge.memory
        except PicoError:
            return None

    def verify(
        self, revision: str | None = None, told: Sequence[GoalRead] = (), report: RunReport | None = None
    ) -> Verified:
        """Return how the bench as observed stands against a revision, or the manifest, and its expectations; and
        whether any bench ever stood as that commit (HEAD for the manifest) says. `report`: of what was measured for
        that just now, see `to_verify`, and goals of which was `told` without."""
        from pico.bench.by_light import unaligned, unfound
        from pico.bench.light import Lights
        from pico.history import runs as recording
        from pico.model.state import references_of
        from pico.model.trace.expectation import Verified
        from pico.policy.expectations import check_expectations
        from pico.runs.evidence import stands
        from pico.runs.unstated_settings import tell

        folder, setup = self.opened.folder, self.opened.setup
        wanted = folder.state_at(revision) if revision else folder.state
        seen = replace(self.opened.observe(), measurements=report.measurements if report else {})
        if setup.lab.goals:
            from pico.bench.alignment.own_values import with_own_values

            seen = with_own_values(self.opened, seen, wanted, revision=revision)
        committed = wanted if revision else folder.committed()
        asked = references_of(wanted) or (committed is not None and references_of(committed))
        memory = self.opened.edge.memory if asked else None  # else a damaged journal hides nothing
        changes = (*drift_of(setup, seen, wanted), *unfound(setup, memory, seen, wanted))
        left = committed is not None and (
            not stands(setup, seen, committed) or bool(unaligned(setup, memory, seen, committed))
        )
        return Verified(
            goal=revision or "the manifest", observed_at=seen.observed_at, changes=changes,
            expectations=check_expectations(setup, seen, wanted.expect, self._measurables()),
            standing=recording.standing_of(folder, revision),
            left=left,
            goals=(*(report.read or () if report else ()), *told) if report or told else None,
            light=Lights(self.opened).compared(revision, report.measurements) if report else None,
            unread=unread_values(seen, wanted) or None,
            unstated=tell(setup, self._memory(), seen, wanted) or None,
        )  # fmt: skip

    def expected(self, plan: Plan) -> Verified:
        """Return what became of the expectations of a plan's goal, which the bench has reached already."""
        from pico.model.trace.expectation import Verified
        from pico.policy.expectations import check_expectations

        seen = self.opened.observe()
        found = check_expectations(self.opened.setup, seen, plan.target.expect or (), self._measurables())
        return Verified(goal=plan.target.name, observed_at=seen.observed_at, expectations=found)


def _at_shortest(kind: ComponentType, found: Measurement) -> bool:
    """Return whether a measurement was taken at the shortest exposure that its camera has."""
    exposure, used = kind.tunables.get("exposure"), found.settings.get("exposure")
    least = exposure.range[0] if exposure and exposure.range else None
    return least is not None and isinstance(used, int | float) and used <= least * (1 + 1e-9)


def _within_noise(found: Measurement) -> bool:
    """Return whether a measurement has no number beyond its noise; one that is unknown has none."""
    if found.unknown:
        return True
    read = [(value, sigma) for value, sigma, _ in found.numbers.values() if isinstance(value, int | float)]
    return bool(read) and all(sigma is not None and abs(value) <= NOISE * sigma for value, sigma in read)
