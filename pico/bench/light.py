"""The light on a bench: of what stands there, of a revision, of the manifest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from pico.bench.opened import Opened
from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error, warning

if TYPE_CHECKING:
    from pico.diagnosis.claims import Budgeted
    from pico.diagnosis.grouping import Suspect
    from pico.drawing.picture import Image
    from pico.history.runs.recorded_light import RecordedLight
    from pico.model.diff import Change
    from pico.model.goal import Looks
    from pico.model.measurement import Compared, Measurement
    from pico.model.observation import Observation
    from pico.model.pose import Pose
    from pico.model.quantities import Value
    from pico.model.setup import Setup
    from pico.optics.axis import Values
    from pico.optics.beam_table import BeamRow
    from pico.optics.light import Light


@dataclass(frozen=True)
class Beams:
    """The beams of what was asked for, `goal` in words: rows of `pico.optics.beam_table`; the sources that are `dark`
    as set, and were followed all the same; what is wrong."""

    goal: str
    rows: tuple[BeamRow, ...]
    dark: tuple[str, ...]
    diagnostics: tuple[Diagnostic, ...]


class Lights:
    """The light of one bench."""

    def __init__(self, opened: Opened) -> None:
        self.opened, self.folder = opened, opened.folder

    def beams(self, revision: str | None = None, *, manifest: bool = False, source: str | None = None) -> Beams:
        """Return where the beams run, with radius, power and polarization: of the bench as it is, or as a revision or
        the manifest wants it, which leave what they do not say as the bench has it; of one source, or of all. A source
        that is off or shut is followed as if it shone.
        Raises PicoError."""
        from pico.optics.beam_table import rows, troubles
        from pico.optics.nominal.specimens import uncertain

        setup, poses, values, goal = self._standing(revision, manifest)
        light, dark = self._traced(setup, poses, values, source)
        unread = () if revision or manifest else _unread(light, self.opened.observe())
        sigmas = uncertain(setup, light, lambda other: self._traced(other, poses, values, source)[0])
        return Beams(goal, rows(light, sigmas), dark, (*unread, *troubles(setup, light)))

    def budget(
        self, what: str, revision: str | None = None, *, to: Value | None = None, looks: Looks | None = None,
        at: Mapping[str, Value] | None = None,
    ) -> Budgeted:  # fmt: skip
        """Return what every error of placement and of a set-point does to a result, in the manifest or a revision, and
        what must be held tighter for it to be known `to` a share (`2 %`) or a size (`1 um`); raises PicoError.

        `what`: a claim of the lab, or an expression over measured numbers, spoken of by the names of `looks`:
        `budget("(a.cam.centroid.y - b.cam.centroid.y) / 2", "e1", looks={"a": {"p1.angle": 1.0}, "b": {"p1.angle":
        179.0}})`. `at`: tunables by address that are supposed to be set otherwise.
        """
        from pico.diagnosis.claims import budgeted, judged

        setup, state = self.folder.setup, self.folder.state_at(revision) if revision else self.folder.state
        claim = (setup.lab.claims or {}).get(what)
        if claim is None:
            return judged(budgeted(setup, state, what, looks, at), to)
        found = budgeted(setup, state, claim.of, {**(claim.looks or {}), **(looks or {})}, at)
        return judged(found, claim.to if to is None else to, what)

    def budgets(self, what: str, a: str, b: str | None = None) -> tuple[Budgeted, Budgeted]:
        """Return the error budgets of a result in two revisions, or in one and the manifest; raises PicoError where it
        can be told in neither."""
        from pico.diagnosis.claims import Budgeted

        found, wrong = [], []
        for revision in (a, b):
            try:
                found.append(self.budget(what, revision))
            except PicoError as exc:
                wrong.append(exc)
                found.append(Budgeted(what, why=exc.diagnostics[0].summary))
        if len(wrong) == len(found):
            raise wrong[0]
        return found[0], found[1]

    def claims(self, revision: str | None = None) -> tuple[Budgeted, ...]:
        """Return the claims of the lab with their error budgets, in the manifest or a revision; raises PicoError."""
        from pico.diagnosis.claims import claims_in

        state = self.folder.state_at(revision) if revision else self.folder.state
        return tuple(claims_in(self.folder.setup, state))

    def recorded(self, revision: str | None = None) -> RecordedLight:
        """Return what a revision recorded of its light; without one HEAD, where the manifest is as it says. Raises
        PicoError."""
        from pico.history.runs.recorded_light import RecordedLight, recorded_light

        folder = self.folder
        if revision:
            return recorded_light(folder, folder.history().resolve(revision).id)
        head, committed = folder.head(), folder.committed()
        if head is None or head.commit is None or committed is None or committed.as_json() != folder.state.as_json():
            return RecordedLight()
        return recorded_light(folder, head.commit)

    def compared(self, revision: str | None, now: Mapping[str, Measurement]) -> tuple[Compared, ...]:
        """Return the light that a revision recorded (see `recorded`) against what was measured `now`, by address, of
        the bench as it stands; raises PicoError. Only parts that were put down since may stand otherwise of
        themselves: as cameras saw them both times, as long as nothing was aligned otherwise on the way of the light,
        which made up for that."""
        from pico.bench.aligned import standing
        from pico.optics.axis import beams
        from pico.optics.nominal.restood import again, realigned
        from pico.optics.nominal.spread import spread
        from pico.planning.goal_light import kept_back, standing_poses
        from pico.runs.light_compared import light_compared
        from pico.runs.put_down import put_down_since

        setup, seen, before = self.opened.setup, self.opened.observe(), self.recorded(revision)
        if not before.measured:
            return ()
        poses, detectors = standing_poses(seen), {one.component for one in before.measured.values()}
        ways = [(axis, d) for axis in beams(setup, poses, seen.known_values) for d in detectors if axis.ways(d)]
        lasers = {d: axis.source for axis, d in ways}
        on_the_way = [(d, {axis.source, *(m.component for way in axis.ways(d) for m in way)}) for axis, d in ways]
        dark = {d: why for d, parts in on_the_way if (why := kept_back(setup, seen, parts, {}))}
        met = {part for _, parts in on_the_way for part in parts}
        then = {} if realigned(setup, met, before.seen, seen.components) else before.seen
        since = put_down_since(self.opened.edge.memory, min(one.at for one in before.measured.values()))
        moved = [name for name in sorted(poses) if setup.movable(name) and (since is None or name in since)]
        placed = {name: again(setup, name, then.get(name), seen.components[name]) for name in moved}
        open_to = spread(setup, poses, seen.known_values, placed, sorted(lasers))
        aligned = {one.goal for one in standing(self.opened, seen) if one.status == "aligned"} & before.goals.keys()
        held = {name: goal for name, goal in (setup.lab.goals or {}).items() if name in aligned}
        return light_compared(setup, before.measured, now, open_to, held, lasers, dark)

    def suspected(self, numbers: Sequence[Compared], off: Sequence[Change] = ()) -> tuple[Suspect, ...]:
        """Return what may have happened where light is not as it was (see `compared`), the likeliest first, nothing
        unusual among it; none where no number differs. By the ray model of the bench as it is seen. `off`: how that
        differs from what is compared with: where more does than what light itself found, that is reason enough, and
        nothing is suspected."""
        from pico.diagnosis.recorded import nominal_of, suspected
        from pico.optics.axis import beams
        from pico.planning.goal_light import standing_poses

        setup, seen = self.opened.setup, self.opened.observe()
        if not any(one.differs for one in numbers) or any(_apart_from_light(setup, change) for change in off):
            return ()
        detectors = {one.address.partition(".")[0] for one in numbers}
        parts = set(detectors)
        for axis in beams(setup, standing_poses(seen), seen.known_values):
            for way in (way for d in detectors for way in axis.ways(d)):
                parts |= {axis.source, *(m.component for m in way)}
        found = suspected(nominal_of(setup, seen), numbers, parts & setup.lab.inventory.keys())
        return found.suspects if found else ()

    def picture(
        self, revision: str | None = None, *, manifest: bool = False, source: str | None = None, out: Path | None = None
    ) -> Image:
        """Return a picture (height, width, 3) from above with the beams as they run, in red those that the beam audit
        finds fault with; raises PicoError."""
        from pico.drawing.light import render_light
        from pico.drawing.picture import write_png
        from pico.optics.audit.audit import audit

        setup, poses, values, _ = self._standing(revision, manifest)
        light = self._traced(setup, poses, values, source)[0]
        verdict = audit(setup, poses, values, {c.beam.source for c in light.crossings})
        image = render_light(setup, poses, light, red=[f.path for f in verdict.findings])
        if out is not None:
            write_png(image, out)
        return image

    def _standing(self, revision: str | None, manifest: bool) -> tuple[Setup, dict[str, Pose], Values, str]:
        from pico.bench.picturing.contents import places, standing, wanted, with_strangers
        from pico.drawing.beams import standing as upright

        setup, seen = self.folder.setup, self.opened.observe()
        if revision or manifest:  # what a state does not say stays as the bench has it
            state = self.folder.state_at(revision) if revision else self.folder.state
            goal = self.opened.history.name_of(revision) if revision else "the manifest"
            values = {**seen.known_values}
            values |= {name: {**values.get(name, {}), **own} for name, own in wanted(state).items()}
            return setup, upright(standing(setup, state)), values, goal
        setup = with_strangers(setup, seen)
        return setup, upright(places(setup, seen, {})), seen.known_values, "the bench as it is"

    def _traced(
        self, setup: Setup, poses: dict[str, Pose], values: Values, source: str | None
    ) -> tuple[Light, tuple[str, ...]]:
        from pico.optics.light import is_dark, light_of

        sources = sorted(n for n in poses if setup.type_of(n).optics.element == "source")
        if source is not None and source not in sources:
            hint = did_you_mean(source, sources) or f"sources here: {', '.join(sources) or 'none'}"
            raise PicoError(error("no-source", f"{source} is no source of light on this bench", hint=hint))
        asked = [source] if source else sources
        light = light_of(setup, poses, values, lit=lambda name: name in asked)
        return light, tuple(name for name in asked if is_dark(values.get(name, {})))


def _apart_from_light(setup: Setup, change: Change) -> bool:
    """Whether a change is none that light itself made: of a tunable that a goal restores."""
    if change.tolerated or change.tunable == "pose":
        return not change.tolerated
    return setup.type_of(change.component).tunables[change.tunable].restore.kind != "align"


def _unread(light: Light, seen: Observation) -> tuple[Diagnostic, ...]:
    """Return a warning for each part that light meets with a tunable that nobody knows."""
    found = []
    for name in sorted({c.component for c in light.crossings}):
        part = seen.components.get(name)
        for tunable, live in sorted(part.values.items()) if part else ():
            if live.status == "unknown":
                text = f"nobody knows {name}.{tunable}: the beam is followed as if it were never set"
                found.append(warning("unread", text, hint=f"`pico do {name} home` finds out", address=name))
    return tuple(found)
