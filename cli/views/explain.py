"""Why a plan is as it is: why each move, why in this order, why not fewer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from pico.model.plan import Plan
from pico.model.record import as_json
from pico.planning.explaining.explain import Because, ExplainedOperation, Explanation, Fewer, Wait, kind_of

from . import diagnostics as diagnostics_view
from .plan import header, reason, what
from .style import count, listed, pad, paint, place, seconds, wrap

_KEY = 10
SHOWN_RINGS = 5


NAMES_BENCH = True
"""The first line says on which bench the plan is."""


def text(plan: Plan, found: Explanation, *, head: str = "", goal: str = "") -> str:
    """Return the reasons of a plan, all of them for one component, in short for the plan as a whole."""
    blocks = [header(plan, head, goal)]
    if found.component is None:
        blocks += _paragraphs([_brief(step) for step in found.steps])
    else:
        blocks += ["\n".join(_full(step)) for step in found.steps] or [_untouched(plan, found.component)]
    moved = found.component is None or any(s.operation.kind.carries for s in found.steps)
    blocks += ["\n".join(block) for block in (_impossible(found), _fewer(found) if moved else []) if block]
    return "\n\n".join(blocks)


def data(plan: Plan, found: Explanation, **_: Any) -> dict[str, Any]:
    """Return schema `pico.explanation/v1`: `steps` with what they wait for and hold up, `fewer`, `clashes`."""
    told = diagnostics_view.data(found.diagnostics)["diagnostics"]
    return {"schema": "pico.explanation/v1", **as_json(found), "diagnostics": told}


def _title(step: ExplainedOperation) -> str:
    op = step.operation
    return f"{paint('bold', op.id)}  {paint('bold', op.address)}  {what(op, step.change)}"


def _why(step: ExplainedOperation) -> str:
    op, change = step.operation, step.change
    said = reason(op.reason, change)
    if op.reason.kind == "changed" and change and change.before is not None:
        if change.tunable == "pose":
            return f"it was seen {_where(change.before)} and belongs {_where(change.after)}"
        before, _, after = change.text.partition(" → ")
        return f"it was {before} and should be {after}"
    return said or {"changed": "it differs from the state wanted", "asked": "somebody asked for it"}.get(
        op.reason.kind, ""
    )


def _where(value: Any) -> str:
    """Return `in storage/a1` or `at (420, 420, 0°)`."""
    shown = place(value)
    return f"at {shown}" if shown.startswith("(") else f"in {shown}"


def _paragraphs(blocks: Sequence[list[str]]) -> list[str]:
    """Return blocks of lines as paragraphs; those of one line stand together."""
    found: list[str] = []
    alone = False
    for lines in blocks:
        if alone and len(lines) == 1:
            found[-1] += f"\n{lines[0]}"
        else:
            found.append("\n".join(lines))
        alone = len(lines) == 1
    return found


def _line(key: str, words: str) -> list[str]:
    """Return `  key     words`, wrapped."""
    first, *rest = wrap(words, " " * (_KEY + 2)) or [""]
    return [f"  {pad(paint('dim', key), _KEY)}{first.strip()}", *rest]


def _full(step: ExplainedOperation) -> list[str]:
    op = step.operation
    lines = [_title(step), *_line("why", _why(step))]
    lines += [part for words in _waits(step.waits_for, True) for part in _line("after", words)]
    lines += [part for words in _waits(step.holds_up, False) for part in _line("before", words)]
    spare = (
        "on the critical path: a delay here delays the whole run"
        if step.critical
        else f"may be {seconds(step.spare)} late"
    )
    when = f"from {seconds(op.start)} to {seconds(op.start + op.seconds)}, takes {seconds(op.seconds)}; {spare}"
    return [*lines, *_line("when", when)]


def _brief(step: ExplainedOperation) -> list[str]:
    told = step.operation.reason.kind != "changed" and _why(step)
    lines = [_title(step), *(_line("why", _why(step)) if told else [])]
    waits = [w for w in step.waits_for if any(b.kind not in ("beam", "parked") for b in w.because)]
    return lines + [part for words in _waits(waits, True) for part in _line("after", words)]


def _waits(waits: Sequence[Wait], past: bool) -> Iterator[str]:
    """Yield a line for each different reason, with the operations that it is the reason of."""
    groups: dict[str, list[Wait]] = {}
    for wait in waits:
        groups.setdefault(_because(wait), []).append(wait)
    for words, same in groups.items():
        names = listed([f"{w.operation} {w.component}" for w in same])
        done = f" (done at {seconds(max(w.until for w in same))})" if past else ""
        yield f"{names}{done}: {words}"


def _because(wait: Wait) -> str:
    if wait.resource:
        return f"{wait.resource} does one thing at a time"
    if not wait.because:
        return "the plan says so"
    first, *more = wait.because
    also = _also(first, more)
    return first.text + (f"; {also}" if also else "")


def _also(first: Because, more: Iterable[Because]) -> str:
    """Return in short that fingers are in the way, too, where bases are."""
    found = [b.contact.overlap for b in more if b.contact and b.contact.kind == "finger"]
    if not found or first.contact is None or first.contact.kind == "finger":
        return ""
    return f"a finger would overlap as well, by {max(found):.3g} mm" if max(found) > 0 else "a finger as well"


def _untouched(plan: Plan, component: str) -> str:
    known = plan.base.state.get(component)
    where = (
        f"it stands at {place(dict(known))}" if known and ("slot" in known or "pose" in known) else "it is where it is"
    )
    words = {
        "stays": f"{component} stays as it is: {where}, and nothing of it is to change in this plan.",
        "absent": f"{component} stays out of this plan: nobody saw it standing.",
        "impossible": f"Nothing is done with {component}, for the plan is impossible.",
    }
    return words.get(kind_of(plan, component), "")


def _impossible(found: Explanation) -> list[str]:
    if not found.clashes and not found.blocks:
        return []
    lines = [paint("bold", "Why it is impossible")]
    lines += [f"  {c.a} and {c.b} can't both stand where they should: {c.by.text}" for c in found.clashes]
    return lines + [part for b in found.blocks for part in wrap(b.text, "  ")]


def _fewer(found: Explanation) -> list[str]:
    return [*_moves(found.fewer), *wrap(_time(found), "  ")] if found.fewer.moves else []


def _time(found: Explanation) -> str:
    """Return how much faster another order could be."""
    if found.bound is None or found.fewer.moves < 2:
        return ""
    if found.makespan - found.bound < 0.05:
        return f"No order of these moves takes less than {seconds(found.makespan)} (proven)."
    return f"No order of these moves takes less than {seconds(found.bound)}; this one takes {seconds(found.makespan)}."


def _moves(fewer: Fewer) -> list[str]:
    s = fewer.staging
    lines = [paint("bold", "Why not fewer moves")]
    parts = f"{count(fewer.moved, 'component')} must move"
    if fewer.moves == fewer.moved:
        return [*lines, f"  {parts}, each moves once: no plan has fewer."]
    stops = count(fewer.moves - fewer.moved, "stop")
    proof = "no plan has fewer (proven)" if s.proven else "that fewer would do is not ruled out"
    if s.lower_bound and not s.proven:
        proof = f"at least {s.lower_bound} {'is' if s.lower_bound == 1 else 'are'} needed; {proof}"
    lines += wrap(f"{parts}, with {stops} on the way: {proof}.", "  ")
    for ring in fewer.rings[:SHOWN_RINGS]:
        names = [b.blocker for b in ring]
        lines += wrap(f"{listed(names, 12)} block one another in a ring; one of them must step aside:", "  ")
        lines += [part for b in ring for part in wrap(b.text, "    ")]
    more = len(fewer.rings) - SHOWN_RINGS
    return lines + ([f"  and {count(more, 'more ring')}; --json has them all"] if more > 0 else [])
