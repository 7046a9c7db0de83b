"""Committing what stands on the bench: who wins where bench and manifest differ, what the commit rests on and says.

All of it happens in one go under the lock of writers, on the files as they are by then: what two people commit at once
is in one commit or in the other.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from datetime import datetime
from types import MappingProxyType
from typing import Literal, get_args

from pico.bench.aligned import stands as goals_stand
from pico.bench.alignment.own_values import found_by_light, never_set, not_held, with_own_values
from pico.bench.by_light import unaligned
from pico.bench.cut_short import cut_short, told_with
from pico.bench.in_use import in_use
from pico.bench.opened import Opened
from pico.diagnostics import Diagnostic, ExitCode, PicoError, did_you_mean, error
from pico.edge.network.opening import remembered
from pico.edge.network.remotes import Place
from pico.history import runs as recording
from pico.history.lab.contents import Contents, contents, nothing
from pico.history.lab.contents import commit as committed
from pico.history.lab.folder import LabFolder
from pico.history.messages.default import default_message
from pico.history.messages.trailers import (
    BENCH,
    EVIDENCE,
    LAB,
    STATE,
    require_message,
    require_meta,
    values,
)
from pico.history.runs.benches import pending_elsewhere
from pico.history.writing.in_progress import message_of, require_resolved
from pico.model.address import Named, holds, read_addresses
from pico.model.comparing.status import refuse_unapplied
from pico.model.diff import Change, diff_states
from pico.model.observation import Observation, live_state
from pico.model.plan import Plan
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.model.state import LabState, home_state, references_of, state_from_json
from pico.model.trace.report import Captured, Committed
from pico.model.trace.run import GoalStood
from pico.places.lost import refusal
from pico.planning.aligned_values import GoalMet
from pico.runs.evidence import by_hand, changed_by, evidence, never_here, stands
from pico.runs.unstated_settings import in_words, unstated_settings

CommitMode = Literal["strict", "capture", "planned"]
WAIT = "wait for its end, or `pico stop` ends it safely; `pico commit --planned` leaves the bench out"


class Commits:
    """Captures and commits of one bench."""

    def __init__(self, opened: Opened) -> None:
        self.opened, self.folder = opened, opened.folder

    def capture(self, *only: str, write: bool = True) -> Captured:
        """Write what the bench shows otherwise than the manifest, beyond tolerance, into the manifest.

        `only`: these components or tunables (`p2`, `p1.angle`). Without `write`, say what would be written. Raises
        PicoError: exit code LOCKED where something would be written while somebody moves the bench.
        """
        named = read_addresses(self.folder.setup, only) if only else None
        seen, moved = self._seen() if write else (self.opened.observe(), None)
        if moved:
            raise moved
        with told_with(self.opened, seen):
            _refuse_in_hand(seen, named)
        kept = _kept(self.folder, seen, named)
        unstated = self._unstated(seen, self.folder.state)
        captured = self._captured(seen, named, self._light(seen), unstated, write=write)
        return replace(captured, by_light=kept or None)

    def wanted(self, plan: Plan, *only: str, write: bool = True) -> Captured:
        """Write what a plan leads to of `only` these tunables into the manifest, as it was asked for; the bench stays.
        Without `write`, say what would be written. Raises PicoError."""
        goal = state_from_json(self.folder.setup.lab.name, plan.target.state)
        return self.folder.write_wanted(goal, read_addresses(self.folder.setup, only), write=write)

    def _seen(self) -> tuple[Observation, PicoError | None]:
        """Look at the bench; what stands there while somebody moves it is no state that anybody wanted: nothing of it
        counts then, and this says who; nor does what a bench shows that was lost."""
        before, seen = in_use(self.opened, WAIT), self.opened.observe()
        moved = before or in_use(self.opened, WAIT) or refusal(self.opened.place)
        return (replace(seen, components={}) if moved else seen), moved

    def _used(self) -> bool:
        return self.opened.wait(self.opened.edge.describe()).kept

    def _captured(
        self, seen: Observation, named: Named | None, light: Mapping[str, GoalMet], unstated: Mapping[str, Value],
        *, write: bool = True,
    ) -> Captured:  # fmt: skip
        """Write what the bench shows, with the values that goals found (`light`) and settings that no state names
        (`unstated`); say which values of goals were written."""
        setup = self.folder.setup
        live, values = live_state(setup, seen, sure=True), {**unstated, **_values(light)}
        captured = self.folder.capture(live, named, values, write=write)
        written = {f"{c.component}.{c.tunable}" for c in captured.changes} & light.keys()
        goals = {light[address].goal for address in written}
        aligned = {goal: tuple(sorted(a for a in written if light[a].goal == goal)) for goal in sorted(goals)}
        return replace(captured, aligned=aligned or None)

    def _light(self, seen: Observation) -> Mapping[str, GoalMet]:
        """Return the tunables whose live values a met goal found, of the lab or ready-made."""
        with remembered(_place(self.folder)) as memory:
            return found_by_light(self.folder.setup, memory, seen)

    def _unstated(self, seen: Observation, *states: LabState | None, since: datetime | None = None) -> dict[str, Value]:
        """Return what was set here and none of `states` names, at `since` or later; see `unstated_settings`."""
        with remembered(_place(self.folder)) as memory:
            return unstated_settings(self.folder.setup, memory, seen, *states, since=since)

    def _set_since(self, seen: Observation) -> dict[str, Value]:
        """Return the settings that a commit adds: those made since HEAD that neither it nor the manifest names. A line
        that somebody removed and committed stays out."""
        folder = self.folder
        head = folder.history().head().commit
        since = folder.history().resolve(head).time if head else None
        return self._unstated(seen, folder.committed(), folder.state, since=since)

    def _with_own(self, seen: Observation, state: LabState) -> Observation:
        return with_own_values(self.opened, seen, state) if self.folder.setup.lab.goals else seen

    def commit(
        self,
        message: str | None = None,
        mode: CommitMode = "strict",
        *,
        only: Collection[str] = (),
        meta: Mapping[str, str] = MappingProxyType({}),
        empty: bool = False,
    ) -> Committed:
        """Capture and commit the manifests, with the runs that led to what they say.

        `message`: why; the physical diff where None. `mode`: `strict` refuses edits that were never applied; `capture`:
        the bench wins; `planned`: the manifest wins where all of it can stand (exit code IMPOSSIBLE else), and the
        commit says where it was never realized. `only`: components, or single tunables, whose files are to be committed
        and that may be captured; all where there are none. `meta`: what else is to be recorded. `empty`: also where
        nothing changed.

        A commit that ends a merge, a cherry-pick or a revert captures nothing: it is about two histories, and a
        hypothesis until the bench stands so. Every commit at whose state the bench stands carries the runs that no
        other has yet. Raises PicoError: for edits that were never applied, nothing to commit, and what git refuses;
        exit code LOCKED where it would capture while somebody moves the bench.
        """
        if mode not in get_args(CommitMode):
            hint = did_you_mean(str(mode)[:40], get_args(CommitMode))
            raise PicoError(error("request", f"there is no commit mode `{str(mode)[:40]}`", hint=hint))
        if message is not None:
            require_message(message)
        if mode == "planned":
            from pico.history.merge.checked import overlapping

            if found := overlapping(self.folder.manifests):
                raise PicoError(found, ExitCode.IMPOSSIBLE)
        seen, moved = self._seen()
        require_meta(meta)
        folder, repository = self.folder, self.folder.history()
        with told_with(self.opened, seen), folder.writing("pico commit"):
            ending = require_resolved(repository.root, repository.own)
            named = read_addresses(folder.setup, only) if only and not ending else None
            captured, light = Captured(), self._light(seen)
            if moved and not ending and mode != "planned":
                raise moved
            if not ending:
                _refuse(folder, self._with_own(seen, folder.state), mode, named, used=self._used())
            if not ending and mode != "planned":
                captured = self._captured(seen, named, light, self._set_since(seen))
            content = contents(folder, named)
            seen = self._with_own(seen, content.state)
            missed = _unaligned(folder, seen, content.state)
            realized = stands(folder.setup, seen, content.state) and not missed
            goals = _goals(folder, seen, content.state) if realized else None
            runs = recording.pending(folder, seen, content.state, goals) if realized else {}
            if not (content.paths or runs or ending or empty):
                raise PicoError([*repository.noticed, nothing(named)])
            changes = _changes(folder, content.state)
            if message is None:
                message = (message_of(repository.own) if ending else "") or _message(folder, content, changes, runs)
            counts = _evidence(folder, seen, content.state, changes, runs, self.opened.fidelity)
            counts = "planned" if missed else counts
            hands = None if ending else _hands(folder, seen, content.state, changes, runs)
            made = committed(
                folder, message, captured.changes, counts, runs=runs, meta=meta, named=named, hands=hands, empty=empty
            )  # fmt: skip
        made = replace(made, aligned=captured.aligned)
        told = (*cut_short(self.opened, seen), *made.diagnostics, *_uncarried(folder))
        told = (*told, *not_held(folder.setup, content.state, seen, light))
        told = (*told, *_in_no_state(folder.setup, self._unstated(seen, content.state)))
        return replace(made, diagnostics=(*told, *pending_elsewhere(self.opened.place)))

    def draft(self, mode: CommitMode = "strict", *, only: Collection[str] = (), empty: bool = False) -> str:
        """Return the message that `commit` would write where nobody says why; raises PicoError as that does."""
        (seen, moved), folder, repository = self._seen(), self.folder, self.folder.history()
        ending = require_resolved(repository.root, repository.own)
        if ending:
            return message_of(repository.own)
        if moved and mode != "planned":
            raise moved
        named = read_addresses(folder.setup, only) if only else None
        _refuse(folder, self._with_own(seen, folder.state), mode, named, used=self._used())
        captured, state = (Captured(), folder.state)
        if mode != "planned":
            values = {**self._set_since(seen), **_values(self._light(seen))}
            captured, state = folder.preview(live_state(folder.setup, seen, sure=True), named, values)
        content = contents(folder, named)
        if not (captured.files or content.paths or empty or recording.awaited(folder)):
            raise PicoError(nothing(named))
        among = named.keys() | (content.components or ()) if named else folder.setup.lab.inventory
        changes = tuple(c for c in _changes(folder, state) if c.component in among)
        return default_message(changes, captured.files or content.paths)


def _values(light: Mapping[str, GoalMet]) -> dict[str, Value]:
    return {address: one.values[address] for address, one in light.items()}


def _in_no_state(setup: Setup, settings: Mapping[str, Value]) -> Iterator[Diagnostic]:
    """Yield what a commit does not hold though it was set on the bench."""
    if settings:
        them = "it" if len(settings) == 1 else "them"
        text = f"set on the bench, but in no state: {in_words(setup, settings)}"
        hint = f"`pico capture {' '.join(settings)}` writes {them} into the manifest"
        yield Diagnostic("note", "in-no-state", text, hint=hint)


def _kept(folder: LabFolder, seen: Observation, named: Named | None) -> tuple[str, ...]:
    """Return the set-points which light finds that a capture leaves as they are, though the bench is elsewhere."""
    missed = _unaligned(folder, seen, folder.state)
    return tuple(a for a in missed if named is None or holds(named, a.partition(".")[0], a.partition(".")[2]))


def _place(folder: LabFolder) -> Place:
    """Return the bench whose state is captured or committed."""
    assert folder.place is not None, "a bench that is open has a place"
    return folder.place


def _uncarried(folder: LabFolder) -> tuple[Diagnostic, ...]:
    """Return the claims of the lab that the tolerances of what was committed do not carry; looked at where there are
    any."""
    if not folder.setup.lab.claims:
        return ()
    from pico.diagnosis.claims import uncarried

    return tuple(one for _, one in uncarried(folder.setup, folder.state))


def _unaligned(folder: LabFolder, seen: Observation, state: LabState) -> Mapping[str, str]:
    """Return the set-points of a state that light has yet to find here, each with why."""
    if not references_of(state):
        return {}
    with remembered(_place(folder)) as memory:
        return unaligned(folder.setup, memory, seen, state)


def _goals(folder: LabFolder, seen: Observation, state: LabState) -> Mapping[str, GoalStood] | None:
    """Return how goals stand that have light, or were sought; None where there are none."""
    if not (folder.setup.lab.goals or references_of(state)):
        return None
    with remembered(_place(folder)) as memory:
        found = goals_stand(folder.setup, memory, seen, state, timed=False)
    told = [one for one in found if one.order is not None or one.status != "never measured"]
    stood = {one.goal: GoalStood(status=one.status, why=one.why, at=one.at, last=one.last) for one in told}
    return stood or None


def _refuse(folder: LabFolder, seen: Observation, mode: CommitMode, named: Named | None, *, used: bool) -> None:
    """Raise PicoError where edits, or the last commit, were never applied here, and nobody said who wins. `used`: the
    bench is not one that was only just made up: such a one never stood as anybody has committed."""
    if mode != "planned":
        _refuse_in_hand(seen, named)
    if mode != "strict":
        return
    components = contents(folder, named).components if named else None
    committed = folder.committed()
    with remembered(_place(folder)) as memory:
        if committed is not None:
            missed = unaligned(folder.setup, memory, seen, folder.state)
            unset = never_set(folder.setup, memory, seen, folder.state)
            refuse_unapplied(
                folder.setup, committed, folder.state, seen, components, unaligned=missed, unset=unset
            )  # fmt: skip
        found = never_here(folder.setup, memory, seen, folder.state, stood=_stood(folder) if used else None)
    never = sorted(
        component if tunable == "pose" else f"{component}.{tunable}"
        for component, tunable in found
        if components is None or component in components
    )
    if never:
        names = ", ".join(never[:6]) + (" and others" if len(never) > 6 else "")
        hint = "`pico apply` first; or `--capture`: the bench wins; or `--planned`: the bench is left out"
        text = f"the last commit was never applied to this bench: {names}"
        if committed is None:  # the first one: there is only the manifest
            text = f"the manifest holds edits that were never applied: {names}"
        raise PicoError(error("unapplied", text, hint=hint))


def _refuse_in_hand(seen: Observation, named: Named | None) -> None:
    """Raise PicoError where a hand holds what is to be captured or committed: it stands nowhere."""
    for name, robot in sorted(seen.robots.items()):
        if robot.holding and (named is None or holds(named, robot.holding, "pose")):
            text = f"{name} holds {robot.holding}, and a manifest says where each part stands"
            hint = "`pico recover` sets it down; or name others, which alone are taken"
            raise PicoError(error("in-hand", text, hint=hint))


def _stood(folder: LabFolder) -> datetime | None:
    """Return when the bench stood as HEAD says, by what HEAD itself tells and could not have copied."""
    head, committed = folder.history().head().commit, folder.committed()
    if head is None or committed is None:
        return None
    commit = folder.history().resolve(head)
    evidence, digest = values(commit.message, EVIDENCE), values(commit.message, STATE)
    realized = evidence and evidence[-1] != "planned" and digest and digest[-1] == committed.digest()
    here = values(commit.message, BENCH)[-1:] in ((), (_place(folder).title,))  # another bench stood so, not this one
    return commit.time if realized and here else None


def _changes(folder: LabFolder, state: LabState) -> tuple[Change, ...]:
    """Return what a commit of `state` changes on the table; a first commit is compared with every part at home."""
    before = folder.committed()
    return diff_states(folder.setup, home_state(folder.setup) if before is None else before, state)


def _message(folder: LabFolder, content: Contents, changes: tuple[Change, ...], runs: Mapping[str, bytes]) -> str:
    inside = folder.history().relative(folder.root)
    paths = (path.removeprefix(f"{inside}/") if inside else path for path in content.paths)
    return default_message(changes, (*paths, *sorted(runs)))


def _evidence(
    folder: LabFolder, seen: Observation, state: LabState, changes: tuple[Change, ...], runs: Mapping[str, bytes],
    observed: str,
) -> str:  # fmt: skip
    documents = [data for path, data in runs.items() if path.endswith("/run.json")]
    changed = {(c.component, c.tunable) for c in changes} | changed_by(documents)
    before = _before(folder)
    with remembered(_place(folder)) as memory:
        return evidence(folder.setup, memory, seen, state, changed, observed=observed, before=before)


def _hands(
    folder: LabFolder, seen: Observation, state: LabState, changes: tuple[Change, ...], runs: Mapping[str, bytes]
) -> list[str] | None:
    """Return what a hand changed of that which a commit changes, by address; None where its runs changed all."""
    made = {(c.component, c.tunable): c.tolerated for c in changes}
    with remembered(_place(folder)) as memory:
        found = by_hand(
            folder.setup,
            memory,
            seen,
            state,
            [one for one, near in made.items() if not near],
            stood=_stood(folder) is not None,
        )
    documents = [data for path, data in runs.items() if path.endswith("/run.json")]
    return [".".join(one) for one in found] if found or made.keys() - changed_by(documents) else None


def _before(folder: LabFolder) -> str:
    """Return what HEAD says that its state of this lab rests on; empty where it says nothing of it."""
    head = folder.history().head().commit
    said = folder.history().resolve(head).message if head else ""
    of_this_lab = any(value.split(" ")[0] == folder.setup.lab.name for value in values(said, LAB))
    return (values(said, EVIDENCE) or ("",))[-1] if of_this_lab else ""
