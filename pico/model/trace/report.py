"""What became of a run: the tally, and what still differs from what was wanted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from pathlib import PurePath
from typing import Literal

from pico.diagnostics import Diagnostic, ExitCode
from pico.model.diff import Change, addresses_of
from pico.model.measurement import Measurement
from pico.model.observation import Observation, slot_at
from pico.model.quantities import Value
from pico.model.record import record
from pico.model.setup import Setup
from pico.model.shown.html import table
from pico.model.state import LabState, place_of
from pico.model.trace.expectation import Expected, GoalRead

BEYOND_TRIM = "beyond-trim"
"""Code of a tunable that light found beyond its trim."""


@record
class GoalEnd:
    """How a goal stood when it had been sought in a run: `met` or not and `why` it ended; how often it was measured and
    how long that took [s]; `last`: what was measured at the end, with `<number>_sigma`, by address."""

    goal: str
    met: bool
    why: str = ""
    measurements: int = 0
    seconds: float = 0.0
    last: Mapping[str, float] | None = None


@record
class RunReport:
    """The end of a run.

    `seconds`: on the backend's clock, `clock` says whose; `wall`: here. `remaining`: what differs from the goal beyond
    tolerance, observed after the run; `absent`: components that are missing, held or toppled; `held`: what each robot
    still has in its gripper. `whole`: the plan was for the whole bench, not for one operation or for some components;
    `scope`: for which (`only p2`), and `left`: what else differs from the goal. `expectations`: of the goal, against
    the bench after a whole run. `measurements`: what was measured, by address; `goals`: those that were sought,
    `aligning`: what all that was there to bring light back took [s]; `read`: those that were measured where they stand.
    `evidence`: what the run counts as.
    `by_light`: set-points that light has yet to find. `unread`: values of the goal, by address, that no device of the
    bench reads. `excepted`: what differs after a whole run and does not count:
    light that is asked for, and values that stay where alignment has the last word. `off`: how far parts that were
    placed stand from where the plan has them, at most: `mm` and `deg`, of which `part` stands farthest off.
    """

    schema: str = "pico.report/v1"
    run: str
    goal: str
    outcome: Literal["done", "failed", "interrupted"]
    done: int = 0
    failed: int = 0
    unknown: int = 0
    skipped: int = 0
    seconds: float = 0.0
    clock: str = "simulated"
    wall: float = 0.0
    evidence: str = ""
    whole: bool = True
    held: Mapping[str, str] = field(default_factory=dict)
    scope: str = ""
    left: tuple[str, ...] = ()
    remaining: tuple[Change, ...] = ()
    absent: tuple[str, ...] = ()
    expectations: tuple[Expected, ...] = ()
    measurements: Mapping[str, Measurement] = field(default_factory=dict)
    by_light: tuple[str, ...] | None = None
    goals: tuple[GoalEnd, ...] | None = None
    aligning: float | None = None
    read: tuple[GoalRead, ...] | None = None
    off: Mapping[str, str | float] | None = None
    excepted: tuple[Change, ...] | None = None
    unread: tuple[str, ...] | None = None
    put_off: int | None = None
    """How many operations are left for the next command, for an arm made the one motion that it makes at a time."""
    diagnostics: tuple[Diagnostic, ...] = ()

    def __repr__(self) -> str:
        return f"<run {self.run}: {self.goal}, {self.outcome}, {self.done} done in {self.seconds:.1f} s>"

    def _repr_html_(self) -> str:
        rows = [(m.address, m.said) for m in self.measurements.values()]
        rows += [(f"{c.component}.{c.tunable}", f"still to be {c.text}") for c in self.remaining]
        below = "; ".join(f"{d.severity}: {d.summary}" for d in self.diagnostics)
        return table(repr(self)[1:-1], ("of", "is"), rows, below)

    @property
    def reached(self) -> bool:
        """Whether the bench, as it was observed after the run, is as was wanted, and every hand is empty; what a hand
        held before single operations that somebody asked for, it may hold after them."""
        return not (self.remaining or self.absent or (self.held and (self.whole or self.scope)))

    @property
    def exit_code(self) -> ExitCode:
        """What a command ends with."""
        if self.put_off and not (self.failed or self.unknown):
            return ExitCode.CHANGES
        if self.outcome == "interrupted":
            return ExitCode.INTERRUPTED
        if self.outcome != "done" or not self.reached:
            return ExitCode.ERROR
        missed = any(not goal.met for goal in self.goals or ())
        return ExitCode.EXPECTATION if missed or any(e.failed for e in self.expectations) else ExitCode.DONE


@record
class Captured:
    """What a capture wrote: the changes from the manifest as it was to the live state, and the files, sorted.

    `written`: false where it was only asked for. `patch`: the lines, as a unified diff. `by_light`: set-points that it
    leaves as they are, for light finds them, though the bench is elsewhere. `aligned`: the addresses among the changes
    that a goal found, by its name.
    """

    changes: tuple[Change, ...] = ()
    files: tuple[str, ...] = ()
    written: bool = True
    patch: str = ""
    by_light: tuple[str, ...] | None = None
    aligned: Mapping[str, tuple[str, ...]] | None = None

    def __repr__(self) -> str:
        if not self.changes:
            return "<captured: nothing differs from the manifest>"
        done = "captured" if self.written else "to be captured"
        return f"<{done}: {addresses_of(self.changes)} into {', '.join(PurePath(name).name for name in self.files)}>"

    def _repr_html_(self) -> str:
        return table(repr(self)[1:-1], ("part", "tunable", "change"), _rows(self.changes))


@record
class Committed:
    """A commit that was made: its id and message, what it changed against its parent, and the digest of its state.

    `captured`: what was taken from the bench for it. `realized`: the bench stood as the commit says when it was made.
    `aligned`: the addresses among these that a goal found, by its name. `evidence`: what that rests on, on which
    `bench`. `runs`: the ids of the runs that it carries. `meta`: what `--meta` recorded.
    """

    commit: str
    message: str
    branch: str | None = None
    state: str = ""
    changes: tuple[Change, ...] = ()
    captured: tuple[Change, ...] = ()
    realized: bool = True
    evidence: str = ""
    bench: str | None = None
    runs: tuple[str, ...] = ()
    meta: Mapping[str, str] = field(default_factory=dict)
    aligned: Mapping[str, tuple[str, ...]] | None = None
    diagnostics: tuple[Diagnostic, ...] = ()

    def __repr__(self) -> str:
        summary, what = self.message.strip().partition("\n")[0], addresses_of(self.changes) or "no change on the table"
        rests = f"{self.evidence}, {self.bench}" if self.bench else self.evidence
        on = f" on {self.branch}" if self.branch else ""
        return f"<commit {self.commit[:7]}{on}: {summary[:60]!r}; {what}; {rests or 'no evidence'}>"

    def _repr_html_(self) -> str:
        below = "; ".join(f"{d.severity}: {d.summary}" for d in self.diagnostics)
        return table(repr(self)[1:-1], ("part", "tunable", "change"), _rows(self.changes), below)


def _rows(changes: Sequence[Change]) -> list[tuple[str, str, str]]:
    return [(c.component, c.tunable, c.text) for c in changes]


@record
class PartRow:
    """One part of the inventory: its type, the parameters of its own as its lab gives them, where it is (or `held`,
    `toppled`; None where nobody sees it), and whether it is free: at rest in storage and not used by the manifest."""

    name: str
    type: str
    title: str
    marker: int | None = None
    serial: str = ""
    home: str | None = None
    where: str | None = None
    free: bool = False
    parameters: Mapping[str, Value] = field(default_factory=dict)


def parts_of(setup: Setup, desired: LabState, seen: Observation, *, free: bool = False) -> tuple[PartRow, ...]:
    """Return the inventory by name with where each part is; only free ones where `free`."""
    rows = []
    for name, part in sorted(setup.lab.inventory.items()):
        live = seen.components.get(name)
        pose = live.pose if live and live.presence == "seen" else None
        slot = slot_at(setup, pose) if pose else None
        elsewhere = live.presence if live and live.presence in ("held", "toppled") else None
        where = slot or (str(pose) if pose else elsewhere)
        resting = slot is not None and setup.movable(name) and place_of(setup, desired, name)[0] is not None
        rows.append(
            PartRow(
                name=name,
                type=part.type,
                title=setup.type_of(name).title,
                marker=part.marker,
                serial=part.serial,
                home=part.home,
                where=where,
                free=resting,
                parameters=part.parameters or {},
            )
        )
    return tuple(row for row in rows if row.free or not free)
