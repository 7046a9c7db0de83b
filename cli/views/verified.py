"""A bench against a state and its expectations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json
from pico.model.trace.expectation import GoalRead, NumberRead, Standing, Verified

from . import light_back
from .by_light import excepted
from .diff import lines
from .measured import value
from .report import expectations
from .runs import shown
from .style import columns, count, on_bench, paint, wrap
from .unread import in_known, in_no_state, unread

if TYPE_CHECKING:
    from pico.diagnosis.grouping import Suspect

_ON: dict[str | None, str] = {"emulated": "emulated devices, never hardware", "hardware": "hardware"}


def text(found: Verified, *, suspects: Sequence[Suspect] = ()) -> str:
    """Return what differs beyond tolerance, and what became of the expectations, of goals and of light; `suspects`: why
    that differs, perhaps."""
    within = sum(change.tolerated and not change.aligned for change in found.changes)
    if found.off:
        verb = "is" if len(found.off) == 1 else "are"
        said = [f"{count(len(found.off), 'tunable')} {verb} not as {found.goal} says:", "", *lines(found.off), ""]
    else:
        near = f", {count(within, 'tunable')} within tolerance" if within else ""
        said = [f"The bench equals {found.goal}{in_known(found.unread or ())}{near}{excepted(found.changes)}."]
    said += [unread(found.unread)] if found.unread else []
    said += [in_no_state(found.unstated)] if found.unstated else []
    said += goals(found.goals or ())
    if found.light:
        commit = found.standing.commit[:7] if found.standing else ""
        said.append(light_back.text(found.light, goal=commit, suspects=suspects))
    said += expectations(found.expectations) or ["The state defines no expectations (`expect:`)."]
    return "\n".join([*said, *(proof(found.standing, left=found.left) if found.standing else [])])


def goals(found: Sequence[GoalRead]) -> list[str]:
    """Return each goal that was measured, with its numbers as they are and as they were, and how many are aligned."""
    if not found:
        return []
    rows, below = [[paint("dim", cell) for cell in ("", "goal", "", "now", "")]], list[list[str]]([[]])
    for one in found:
        mark = {True: paint("green", "✓"), False: paint("red", "✗"), None: paint("yellow", "?")}[one.met]
        own = [[n.address, value(n.value, "", n.sigma), _beside(n)] for n in one.numbers] or [["", "", ""]]
        rows += [[mark if not n else "", one.goal if not n else "", *cells] for n, cells in enumerate(own)]
        why = wrap(f"{one.word}: {one.why}", "     ") if one.why and not one.met else []
        below += [[] for _ in own[1:]] + [why]
    met = sum(bool(one.met) for one in found)
    table = [line for row, more in zip(columns(rows, indent="  "), below, strict=True) for line in (row, *more)]
    return [*table, f"{met} of {count(len(found), 'goal')} aligned."]


def _beside(one: NumberRead) -> str:
    """Return `to 0 within 5, was 0.31`."""
    within = f" within {one.tolerance:g}" if one.tolerance else ""
    wanted = f"to {one.target:g}{within}" if one.target is not None else ""
    return ", ".join(part for part in (wanted, f"was {one.was:.4g}" if one.was is not None else "") if part)


def proof(standing: Standing, *, left: bool = False) -> list[str]:
    """Return in a few lines whether a bench ever stood as a commit says: `4f2c9a1 is verified: ...`; `left`: it does
    not stand so now."""
    colors = {"verified": "green", "inherited": "yellow", "planned": "yellow", "unknown": "red"}
    then = left and standing.verdict == "verified"
    verb, since = ("was", "; the bench has left it since") if then else ("is", "")
    word = paint("yellow" if then else colors[standing.verdict], standing.verdict)
    head = f"{standing.commit[:7]} {verb} {word}: {shown(standing.why)}{since}."
    return [*wrap(head, ""), *(f"  {line}" for line in _said(standing))]


def _said(standing: Standing) -> list[str]:
    if standing.verdict in ("inherited", "planned"):
        return ["This state has not been realized on a bench yet: `pico apply`, then `pico commit`."]
    if standing.verdict == "unknown":
        return []
    what = (
        f"Simulated ({on_bench(str(standing.evidence), standing.bench)}): never hardware."
        if standing.simulated
        else f"On {_ON[standing.evidence]}."
    )
    when = f" {standing.at[:16].replace('T', ' ')} UTC" if standing.at else ""
    if standing.run is None:
        return [what]
    where = f"carried by {standing.carried[:7]}" if standing.carried else "no commit has it yet: `pico commit` takes it"
    return [what, f"The run ended{when}, {where}; `pico runs show {standing.run}`."]


def data(found: Verified, *, suspects: Sequence[Suspect] = ()) -> dict[str, Any]:
    """Return schema `pico.verified/v1`: `goal`, `changes` (`after` is live), `expectations`, `standing`; `goals`,
    `light` and `suspects` where it was measured."""
    written: dict[str, Any] = as_json(found)
    if found.light is not None:
        written |= {"light": light_back.numbers(found.light), "suspects": [as_json(one) for one in suspects]}
    return written
