"""Which run of a bench an undo takes back, and whether the bench still stands as that run left it."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic, PicoError, error
from pico.model.address import renaming_of
from pico.model.diff import deviation, show_value, value_deviation
from pico.model.observation import Observation
from pico.model.operation import touched_by
from pico.model.plan import Plan, plan_from_json
from pico.model.pose import Pose
from pico.model.primitive import primitive
from pico.model.setup import Setup

if TYPE_CHECKING:
    from pico.runs.journal import RunRecord
    from pico.runs.memory import Memory


_WITHIN = ("none", "tolerated")


@dataclass(frozen=True)
class Chosen:
    """A run to be taken back. `runs`: those of the bench that began an operation, the newest first, from the ones that
    only emptied hands after it; `at`: its index among them; `plan`: what it was to do. `explicit`: it was named."""

    runs: tuple[RunRecord, ...]
    at: int
    plan: Plan
    explicit: bool

    @property
    def run(self) -> RunRecord:
        """The run itself."""
        return self.runs[self.at]


def chosen(
    setup: Setup, memory: Memory, word: str | None, of: str | None, me: str, *, undone: bool = False
) -> Chosen:  # fmt: skip
    """Return the run to be taken back: the one whose id begins or ends with `word`, else the last one that left the
    bench otherwise than it found it, beyond tolerance, or was cut short. `of`: of this person. `me`:
    what the journal calls the person who asks. `undone`: a run that is
    an undo, or the undo of the run that is named.

    Raises PicoError if there is none, for a word that fits several, and for a run of somebody else unless `of` names
    that person.
    """
    moving = memory.moving()
    runs = [run for run in reversed(memory.runs()) if run.run in moving]
    own = [run for run in runs if _cause(memory, run) != "recover"]
    if word is not None:
        found = _named(own, memory.runs(), word)
        if undone and _cause(memory, found) != "undo":
            found = _undo_of(memory, own, found)
    else:
        mine = [run for run in own if of is None or operator(memory, run) == of]
        last = next((run for run in mine if changed(setup, memory, run)), None)
        if last is None:
            who = f" by {of}" if of else ""
            text = f"the journal of this bench knows no run{who} that left it otherwise than it found it"
            raise PicoError(error("no-run", text, hint="`pico runs` lists them"))
        found = last
        if undone and _cause(memory, found) != "undo":
            text = f"nothing to redo: the last run that changed the bench is no undo, but {called(memory, found)}"
            raise PicoError(error("nothing-to-redo", text, hint="`pico runs` lists them; `pico redo RUN` names one"))
    _require_own(memory, found, (me, of), "redo" if undone else "undo")
    first = at = runs.index(found)
    while first and _cause(memory, runs[first - 1]) == "recover":
        first -= 1
    return Chosen(tuple(runs[first:]), at - first, document_of(memory, found), word is not None or of is not None)


def changed(setup: Setup, memory: Memory, run: RunRecord) -> bool:
    """Return whether a run left the bench otherwise than it found it, beyond tolerance; so does one that was cut short
    after it had begun to change something."""
    touched = set(begun_by(memory, run))
    after = memory.about(run.run)[1]
    if not touched or run.outcome in (None, "interrupted") or after is None:
        return bool(touched)
    before = document_of(memory, run).base.state
    return any(
        not _same(setup, one, _in_state(before, one), _in_seen(after["components"], one), closely=True)
        for one in touched
    )


def not_in_place(setup: Setup, memory: Memory, seen: Observation, found: Chosen) -> Diagnostic | None:
    """Return what has changed since a run, of that which it changed, and by which run; None if nothing has."""
    run = found.run
    after = next((s for r in found.runs[: found.at + 1] if (s := memory.about(r.run)[1])), None)
    later = [r for r in reversed(memory.runs()) if r.number > found.runs[0].number and r.run in memory.moving()]
    if after is None:
        if not later:
            return None
        text = f"nobody looked at the bench after run {run.run}, which was killed, and others have run since"
        return error("not-in-place", text, hint=f"`pico undo {later[0].run}` first, or `pico apply`")
    for component, tunable in sorted(set(begun_by(memory, run))):
        name = renaming_of(setup.lab).get(component, component)
        one, part = (component, tunable), seen.components.get(name)
        left = _in_seen(after["components"], one)
        live: Any = None
        if part is not None and tunable == "pose":
            live = part.pose if part.presence == "seen" else None
        elif part is not None and tunable in part.values:
            live = part.values[tunable].value
        if _same(setup, one, left, live):
            continue
        by = next((r for r in later if (name, tunable) in _present(setup, begun_by(memory, r))), None)
        now, was = (str(v) if isinstance(v, Pose) else show_value(v) for v in (live, left))
        address = name if tunable == "pose" else f"{name}.{tunable}"
        who = f"by {called(memory, by)}" if by else "by no run"
        text = f"run {run.run} is not in place any more: it left {address} at {was}, and that is at {now} now, {who}"
        hint = f"`pico undo {by.run}` first, or `pico apply`" if by else "`pico apply` brings the bench to the manifest"
        return error("not-in-place", text, hint=hint, address=address)
    return None


def _present(setup: Setup, touched: Iterable[tuple[str, str]]) -> set[tuple[str, str]]:
    """Return components with their tunables, each by the name that the component has now."""
    names = renaming_of(setup.lab)
    return {(names.get(component, component), tunable) for component, tunable in touched}


def called(memory: Memory, run: RunRecord) -> str:
    """Return a run as a person knows it: its id, what it was for, when it began, and whose it is."""
    plan = document_if_any(memory, run)
    what = plan.target.name if plan else run.holder
    if plan is None:
        pass
    elif plan.target.cause in ("undo", "redo"):
        what = f"{plan.target.cause} of {plan.target.of}"
    elif plan.asked or run.holder.startswith("pico optimize"):
        what = next((f"{op.primitive} {op.address}" for op in plan.operations if op.reason.kind == "asked"), what)
    elif not plan.open:
        what = f"{plan.target.cause or 'apply'} {plan.target.name}"
    who = operator(memory, run)
    return f"run {run.run} ({what}; {run.started_at[:16].replace('T', ' ')} UTC{f'; {who}' if who else ''})"


def operator(memory: Memory, run: RunRecord) -> str:
    """Return whose a run is; empty if the journal did not keep it."""
    about = memory.about(run.run)[0]
    return str(about[-1].get("operator", "")) if about else ""


def begun_by(memory: Memory, run: RunRecord, *, ended: bool = True) -> Iterator[tuple[str, str]]:
    """Yield the components with their tunables that the operations change which a run began; without those that it
    `ended`, where that is False."""
    records = memory.records(run=run.run)
    begun = {r.key for r in records if r.kind == "started"} - {r.key for r in records if r.kind == "done" and not ended}
    for record in records:
        if record.kind == "intent" and record.key in begun and primitive(record.data["primitive"]).changes != "nothing":
            yield from touched_by(record.component, record.data["arguments"])


def document_of(memory: Memory, run: RunRecord) -> Plan:
    """Return the plan that a run began with; raises PicoError if the journal has none: the run was salvaged from a
    commit."""
    plan = document_if_any(memory, run)
    if plan is None:
        text = f"the journal has no plan of the run {run.run}, which was salvaged from a commit"
        hint = "`pico plan` shows what differs now; `pico checkout` of a commit brings its state back"
        raise PicoError(error("no-plan", text, hint=hint))
    return plan


def document_if_any(memory: Memory, run: RunRecord) -> Plan | None:
    """Return the plan that a run began with; None if the journal has none, as of a run that was salvaged."""
    text = memory.document(run.run)
    return plan_from_json(text) if text is not None else None


def _cause(memory: Memory, run: RunRecord) -> str | None:
    found: str | None = json.loads(memory.document(run.run) or "{}").get("target", {}).get("cause")
    return found


def _named(runs: Collection[RunRecord], all_runs: Collection[RunRecord], word: str) -> RunRecord:
    from pico.history.runs.benches import fits  # what looks at journals is not needed to open a bench

    found = [run for run in runs if word and fits(word, run.run)]
    if len(found) == 1:
        return found[0]
    if len(found) > 1:
        names = ", ".join(run.run for run in found[:3])
        raise PicoError(error("ambiguous", f"several runs fit `{word}`: {names}", hint="write more of its id"))
    still = any(word and fits(word, run.run) for run in all_runs)
    text = f"run {word} moved and set nothing" if still else f"this bench has no run `{word}`"
    raise PicoError(error("no-run", text, hint="`pico runs` lists them"))


def _undo_of(memory: Memory, runs: Collection[RunRecord], run: RunRecord) -> RunRecord:
    for other in runs:
        plan = document_if_any(memory, other)
        if plan and plan.target.cause == "undo" and plan.target.of == run.run:
            return other
    raise PicoError(error("nothing-to-redo", f"{called(memory, run)} was not undone", hint="`pico runs` lists them"))


def _require_own(memory: Memory, run: RunRecord, whose: Collection[str | None], verb: str) -> None:
    who = operator(memory, run)
    if who and who not in whose:
        text = f"{called(memory, run)} is another person's"
        raise PicoError(error("of-another", text, hint=f"`pico {verb} {run.run} --of {who}` takes it back anyway"))


def _in_state(state: Mapping[str, Any], one: tuple[str, str]) -> Any:
    part = state.get(one[0]) or {}
    return Pose(**part["pose"]) if one[1] == "pose" and part.get("pose") else part.get(one[1])


def _in_seen(parts: Mapping[str, Any], one: tuple[str, str]) -> Any:
    part = parts.get(one[0]) or {}
    if one[1] != "pose":
        return part.get("values", {}).get(one[1], {}).get("value")
    return Pose(**part["pose"]) if part.get("pose") and part.get("presence", "seen") == "seen" else None


def _same(setup: Setup, one: tuple[str, str], a: Any, b: Any, *, closely: bool = False) -> bool:
    """Return whether two values of a tunable are the same within its tolerance. `closely`: of one on which light has
    the last word within its resolution, for to light it matters below the tolerance, too."""
    component, tunable = renaming_of(setup.lab).get(one[0], one[0]), one[1]
    if component not in setup.lab.inventory or a is None or b is None:
        return a is None and b is None
    if tunable == "pose":
        return isinstance(a, Pose) and isinstance(b, Pose) and deviation(setup, component, a, None, b) != "off"
    kind = setup.type_of(component).tunables.get(tunable)
    if kind is None:
        return bool(a == b)
    return value_deviation(kind, a, b) in (("none",) if closely and kind.restore.kind == "align" else _WITHIN)
