"""A plan: where from and to, each operation with its reason, what it costs, what next."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from datetime import datetime
from typing import Any

from pico.backends.devices import EMULATED, HARDWARE
from pico.model.diff import Change
from pico.model.operation import Operation, Reason
from pico.model.plan import Plan
from pico.model.pose import wrap as wrap_angle
from pico.model.primitive import OWN
from pico.model.record import as_json
from pico.model.state import goals_of

from .by_light import excepted, unfound
from .diff import brief
from .style import ago, columns, count, listed, paint, place, seconds, wide, width, wrap
from .unread import in_known, unread

SHOWN_TOLERATED = 5
REAL = (HARDWARE, EMULATED)
BAR = 60
"""Columns for the time of a plan, where several arms are drawn in it."""


NAMES_BENCH = True
"""The first line says on which bench the plan is."""


def text(
    plan: Plan,
    *,
    head: str = "",
    goal: str = "",
    next_step: str = "",
    single: bool = False,
    beside: Sequence[Change] | None = None,
) -> str:
    """Return the screen of a plan. `head` and `goal` name the commits; `next_step` says what to type; `single`: one
    operation that somebody asked for; `beside`: in what the manifest is not as asked, where that is known."""
    blocks = [header(plan, head, goal, single)]
    if plan.operations:
        blocks.append("\n".join(operations(plan)))
        blocks.append("\n".join(timelines(plan)))
    blocks.append(
        "\n".join([*_tolerated(plan), *(part for line in _summary(plan, beside) for part in wrap(line, "  "))])
    )
    if plan.errored:
        blocks.append("This plan can't be applied; what is wrong stands below.")
    elif plan.denied:
        blocks.append("Denied by the policy of this lab: nothing moves.")
    elif next_step and plan.operations:
        blocks.append(next_step)
    return "\n\n".join(block for block in blocks if block)


def data(plan: Plan, **_: Any) -> dict[str, Any]:
    """Return the plan, schema `pico.plan/v1`: what `--out` writes."""
    found: dict[str, Any] = as_json(plan)
    return found


def header(plan: Plan, head: str = "", goal: str = "", single: bool = False, *, now: datetime | None = None) -> str:
    """Return `shel · sim (kinematic) · HEAD C3 → e1 (E1-3 "p2 tilted") · only p2 · seen 2 min ago`."""
    bench = plan.bench or plan.backend
    parts = [paint("bold", plan.lab.name), bench if plan.backend in REAL else f"{bench} ({plan.fidelity})"]
    if single:
        return " · ".join([*parts, "one operation"])
    target = goal or plan.target.name
    parts.append(f"HEAD {head} → {target}" if head else target)
    parts += [plan.target.scope] if plan.target.scope else []
    parts += [f"seen {ago(plan.base.observed_at, now)}"] if plan.base.observed_at else []
    return " · ".join(parts)


def operations(plan: Plan) -> list[str]:
    """Return one line an operation, two where the reason is long."""
    changes = {op.id: change_of(plan, op) for op in plan.operations}
    several = len(arms(plan)) > 1
    whys = reasons(plan)
    rows = [[*_cells(op, changes[op.id], several), why] for op, why in zip(plan.operations, whys, strict=True)]
    lines = columns([row[:-1] for row in rows], indent="  ")
    whole = []
    room = max((width(line) for line in lines), default=0)
    for line, (*_, why) in zip(lines, rows, strict=True):
        if room + 2 + width(why) <= wide() or not why:
            whole.append((line + " " * (room - width(line) + 2) + paint("dim", why)).rstrip())
        else:
            whole += [line, *(paint("dim", w) for w in wrap(why, " " * 6))]
    return whole


def symbol(op: Operation, change: Change | None = None) -> str:
    """Return + placed from storage, - stowed, ~ changed where it is, ↷ makes room, ! a person must act."""
    if op.kind.by_hand:
        return paint("red", "!")
    if op.kind.parks or not op.kind.mutating:
        return paint("dim", "·")
    if op.reason.kind in ("staged", "in_the_way"):
        return paint("yellow", "↷")
    if op.kind.carries:
        if _slot(op.arguments.get("to")):
            return paint("yellow", "-")
        if _slot(_start(op, change)):
            return paint("green", "+")
    return paint("yellow", "~")


def _start(op: Operation, change: Change | None) -> Any:
    """Return where an operation begins: a pose where the part stays in the slot that it is in."""
    start = op.arguments.get("from")
    stays = change and isinstance(start, dict) and change.before == start.get("pose")
    return change.before if change and stays else start


def _slot(where: Any) -> str | None:
    return where.get("slot") if isinstance(where, dict) else None


def step(op: Operation, change: Change | None = None) -> str:
    """Return what an operation does: `storage/a3 → (395, 420, 0°)`, `90 → 1`, `home`."""
    if op.primitive == "optimize":
        return f"by {', '.join(op.arguments['what']['tunables'])}"
    if op.kind.by_hand:
        return "by hand" if "to" not in op.arguments else f"by hand to {place(op.arguments['to'])}"
    if "to" not in op.arguments:
        return op.primitive
    before = _start(op, change)
    goal = place(op.arguments["to"])
    return f"{place(before)} → {goal}" if before is not None else f"→ {goal}"


def change_of(plan: Plan, op: Operation) -> Change | None:
    """Return the change that an operation brings about."""
    if op.reason.kind == "interlock":
        return None
    key = (op.component, op.arguments.get("tunable", "pose"))
    return next((c for c in plan.changes if (c.component, c.tunable) == key), None)


def what(op: Operation, change: Change | None) -> str:
    """Return what an operation does, values with their unit: `90 → 1 deg`."""
    return change.text if change and op.primitive == "set" else step(op, change)


def _cells(op: Operation, change: Change | None, several: bool) -> list[str]:
    took = seconds(op.seconds) if op.seconds >= 0.05 else ""
    robot = "" if op.kind.parks else op.robot or ""
    when = [robot, f"at {seconds(op.start):>6}"] if several else []
    return [f"{symbol(op, change)} {op.address}", what(op, change), *when, f"{took:>6}"]


def arms(plan: Plan) -> tuple[str, ...]:
    """Return the robots that a plan moves, by name."""
    return tuple(sorted({op.robot for op in plan.operations if op.robot}))


def timelines(plan: Plan) -> list[str]:
    """Return a line for each of several arms: when it works, when it waits, and how long it works in all."""
    rows = []
    for robot in arms(plan) if len(arms(plan)) > 1 else ():
        own = [op for op in plan.operations if op.robot == robot]
        line = list("·" * BAR)
        for op in own:
            first, end = (round(BAR * t / plan.makespan) for t in (op.start, op.start + op.seconds))
            line[first:end] = "━" * (end - first)
        rows.append([robot, "".join(line), f"{seconds(sum(op.seconds for op in own)):>6}"])
    return columns(rows, indent="  ")


def reasons(plan: Plan) -> list[str]:
    """Return why each operation of a plan is in it, in words, and whether it is done beside the arm; none is empty."""
    target, several = plan.target, len(arms(plan)) > 1
    says = f"as {target.revision or 'the manifest'} says" if target.revision or not target.title else "as wanted"
    general = {"changed": "as before that run" if target.cause in ("undo", "redo") else says, "asked": "as asked"}
    moving, found = any(op.robot for op in plan.operations), []
    for op in plan.operations:
        change = change_of(plan, op)
        said = reason(op.reason, change)
        if not said or (change and op.primitive == "set" and said == change.text):  # it stands beside it already
            said = general.get(op.reason.kind, "needed for the rest")
        beside = moving and not op.robot and op.reason.kind not in ("interlock", "align")
        beside = beside and op.kind.drives and not several
        found.append(f"{said}, beside the arm" if beside else said)
    return found


def reason(why: Reason, change: Change | None = None) -> str:
    """Return why an operation is in the plan, in words."""
    if why.text:
        return why.text
    of = listed(why.of)
    overlap = f" by {why.overlap:.3g} mm" if why.overlap else ""
    words = {
        "changed": change.text if change and change.text.startswith(("moved ", "turned ")) else "",
        "in_the_way": f"in the way of {of}: they would overlap{overlap}",
        "staged": f"put down on its way: a ring of {of} block one another",
        "stowed": "not wanted on the table",
        "operator": "only a person can do it",
        "asked": "",
        "parked": "leaves the beam free",
    }
    return words.get(why.kind, "")


def _tolerated(plan: Plan) -> list[str]:
    kept, near = ([c for c in plan.changes if c.tolerated and bool(c.aligned) is light] for light in (True, False))
    rows = [[f"  = {_name(c)}", _near(c)] for c in (*kept, *near[:SHOWN_TOLERATED])]
    more = len(near) - SHOWN_TOLERATED
    lines = columns(rows) + ([f"    and {more} more within tolerance"] if more > 0 else [])
    return [paint("dim", line) for line in lines] + ([""] if lines else [])


def _near(change: Change) -> str:
    before, after = change.before, change.after
    if change.aligned:
        number, goal = place(after), change.aligned.goal
        why = (
            f"{goal} was met there {ago(change.aligned.at)}" if change.aligned.at else f"{goal} was not met at {number}"
        )
        return f"kept at {change.text.replace(f' → {number}', '', 1)}, not {number}: {why}"
    if not isinstance(before, dict) or not isinstance(after, dict):
        return f"{change.text}: within tolerance, stays"
    away = math.hypot(after["x"] - before["x"], after["y"] - before["y"])
    turned = wrap_angle(after.get("yaw", 0.0) - before.get("yaw", 0.0))
    return f"already in place ({away:.2f} mm, {abs(turned):.2f}°)"


def _name(change: Change) -> str:
    return change.component if change.tunable == "pose" else f"{change.component}.{change.tunable}"


def tally(operations: Sequence[Operation]) -> str:
    """Return `2 moves, 1 setting, 1 homing`; empty for no operation. Interlocks are the policy's matter."""
    found = Counter(op.kind.counted for op in operations if op.reason.kind != "interlock")
    order = dict.fromkeys([*(p.counted for p in OWN.values()), *found])
    return ", ".join(count(found[words], *words) for words in order if found[words] and any(words))


def _summary(plan: Plan, beside: Sequence[Change] | None) -> list[str]:
    if not plan.operations:
        return [*_idle(plan, beside), *_spoils(plan)]
    parts = [tally(plan.operations)]
    if any(op.kind.carries for op in plan.operations):
        parts.append(_staging(plan))
    arm = sum(op.seconds for op in plan.operations if op.robot) if len(arms(plan)) == 1 else 0.0
    parts.append(f"{seconds(plan.makespan)} in all{_bound(plan)}" + (f", arm {seconds(arm)}" if arm else ""))
    light = [op.seconds for op in plan.operations if op.aligns]
    parts[-1] += f", alignment {seconds(sum(light))}" if light else ""
    line = " · ".join(part for part in parts if part)
    changed = [op for op in plan.operations if op.reason.kind != "interlock" and op.kind.mutating]
    carried = {op.component for op in changed if op.kind.carries}
    known = plan.base.state.keys() | plan.target.state.keys() | carried  # what is held or not seen stands nowhere
    stay = len(plan.base.state.keys() - {op.component for op in changed})
    whole = [line] if width(line) <= wide() - 2 else [" · ".join(parts[:-1]), parts[-1]]
    lines = [*whole, f"{count(stay, 'component')} of {len(known)} {'stays' if stay == 1 else 'stay'} as is"]
    lines += [*policy(plan), *_spoils(plan)]
    if plan.target.scope:
        return [*lines, _scope(plan)]
    waiting = plan.absent or plan.unsure or any(d.code == "blocked" for d in plan.diagnostics)
    return [*lines, f"the bench will not equal {goal_name(plan)} yet: the warnings say why"] if waiting else lines


def _spoils(plan: Plan) -> list[str]:
    """Return which goals are to be aligned again after a plan, in their order along the beam, what makes them stale,
    when they were met, what redoing them takes, and the commands."""
    found = plan.spoils or ()
    if not found:
        return []
    texts = (f"{s.goal} ({s.why}{f'; met {ago(s.at)}' if s.at else ''}; {seconds(s.seconds)} to redo)" for s in found)
    each = ", then ".join(f"`pico optimize {s.goal}`" for s in found)
    whole = "" if plan.target.cause == "single" or plan.target.scope else "; or `pico apply --align`"
    if whole and plan.target.revision:
        whole = f"; or `pico apply {plan.target.revision} --align`"
    return [f"align again: {', '.join(texts)}: {each}{whole}"]


def _idle(plan: Plan, beside: Sequence[Change] | None) -> list[str]:
    """Return why a plan without operations has none."""
    if plan.absent:
        return [f"Nothing to move, but {listed(plan.absent)} can't be seen: the bench is not {goal_name(plan)}."]
    if plan.errored:
        return []
    if not plan.reached:
        names = dict.fromkeys([*(c.component for c in plan.changes if c.counts), *plan.unsure])
        return [
            f"Nothing can be moved, but the bench is not {goal_name(plan)}: the warnings say why ({listed([*names])})."
        ]
    if plan.target.scope:
        return [f"Nothing to do ({plan.target.scope}). A plan that names no component is for all."]
    if plan.target.cause == "single":
        return [_as_asked(beside)]
    return [line for line in (_as_wanted(plan), unread(plan.unread or ())) if line]


def _as_wanted(plan: Plan) -> str:
    if said := {d.address for d in plan.diagnostics if d.code == "by-light"}:
        goals = goals_of(plan.target_state).values()
        missed = [address for of in goals if said & of.keys() for address in of]
        return f"Nothing to do by numbers. {unfound(goal_name(plan), missed or sorted(said))}"
    if plan.target.cause == "recover":
        return "Nothing to do: no gripper holds anything, and no arm stands where it was stopped."
    return f"Nothing to do: the bench equals {goal_name(plan)}{in_known(plan.unread or ())}{excepted(plan.changes)}."


def _as_asked(beside: Sequence[Change] | None) -> str:
    if beside:
        found = f"Nothing to do: the bench is as asked already. The manifest is not ({brief(beside)})"
        return f"{found}: `pico capture` updates the manifest."
    return f"Nothing to do: {'it is' if beside is None else 'bench and manifest are'} as asked already."


def policy(plan: Plan) -> list[str]:
    """Return `policy: 3 rules hold · laser shutter closed during 2 moves`, and a line for each rule that does not."""
    rules = [rule for rule in plan.policy if "level" in rule]
    holding = sum(bool(rule["holds"]) for rule in rules)
    said = [f"{count(holding, 'rule')} {'holds' if holding == 1 else 'hold'}"] if holding else []
    said += [rule["text"] for rule in plan.policy if "level" not in rule]
    lines = [f"policy: {' · '.join(said)}"] if said else []
    for rule in rules:
        if not rule["holds"]:
            denied = rule["level"] == "mandatory"
            word = paint("red", "policy denies") if denied else paint("yellow", "policy advises")
            lines.append(f"{word}: {rule['rule']}: {rule['text']}")
    return lines


def _scope(plan: Plan) -> str:
    """Return that a plan is for some components, and whether the bench will be as the target says nevertheless."""
    left = plan.absent or plan.unsure or any(d.code in ("left", "sample") for d in plan.diagnostics)
    will = f"the bench will {'not equal' if left else 'equal'} {goal_name(plan)}"
    return paint("yellow", f"{plan.target.scope}: {will}" + ("" if left else ", for nothing else differs"))


def _bound(plan: Plan) -> str:
    """Return how much of the time no other order of the same operations saves, where that is known."""
    if plan.bound is None or sum(op.kind.carries for op in plan.operations) < 2:
        return ""
    least = plan.makespan - plan.bound < 0.05
    return " (least possible)" if least else f" (at least {seconds(plan.bound)})"


def _staging(plan: Plan) -> str:
    s = plan.staging
    if s.proven and not s.count:
        return "no part is put aside on the way"
    if s.proven:
        return f"{s.count} staged (fewest possible, proven)"
    return f"{s.count} staged" + (
        f" (at least {s.lower_bound} needed)" if s.lower_bound else " (perhaps not the fewest)"
    )


def goal_name(plan: Plan) -> str:
    """Return what the plan leads to, as a person calls it."""
    return plan.target.name
