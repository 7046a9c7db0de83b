"""Where the bench has left the last commit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.bench.drifting.drift import Drift, Drifted, LightLost
from pico.model.record import as_json
from pico.model.state import is_reference, reference_from_json

from .by_light import excepted
from .diff import lines
from .style import ago, count, listed, paint, wrap
from .unread import in_known, in_no_state, unread


def text(found: Drifted, bench: str) -> str:
    """Return what drifted on a bench beyond tolerance, and how much within it."""
    beyond, head = found.beyond, found.head
    kept = [d.change for d in found.within if d.change.aligned]
    near = len(found.within) - len(kept)
    within = f"{count(near, 'tunable')} {'deviates' if near == 1 else 'deviate'} within tolerance." if near else ""
    ignored = f"Ignored by the policy of the lab: {listed(found.ignored)}." if found.ignored else ""
    light = [line for one in found.light or () for line in _light(one)]
    if not beyond:
        title = (
            f"No part has left {head}, and light is lost:"
            if light
            else f"No drift: the bench `{bench}` is as {head} says{in_known(found.unread)}{excepted(kept)}."
        )
        also = unread(found.unread), in_no_state(found.unstated)
        return "\n".join(x for x in (title, *light, within, ignored, *also) if x)
    title = (
        f"{count(len(beyond), 'tunable')} of the bench `{bench}` {'has' if len(beyond) == 1 else 'have'} left {head}:"
    )
    stays = excepted(kept).removeprefix(", except ")
    rest = [
        *([f"No drift: {stays}."] if kept else []),
        *([within] if within else []),
        *([ignored] if ignored else []),
        *([unread(found.unread)] if found.unread else []),
        *([in_no_state(found.unstated)] if found.unstated else []),
        _hint(found),
    ]
    entries = [line for one in _ordered(beyond) for line in _entry(one)]
    return "\n".join([title, "", *entries, "", *light, *rest])


def _light(one: LightLost) -> list[str]:
    """Return whether light is lost with a part that moved, or without."""
    through = f"{listed(one.moved)} {'has' if len(one.moved) == 1 else 'have'} left it, where its light comes through"
    if not one.lost:
        said = f"{one.goal} was aligned {ago(one.at)}; {through}: `pico verify --measure` tells whether it still is."
    elif one.moved:
        said = f"{one.goal} is lost ({one.why}, {ago(one.at)}), and {through}."
    else:
        said = (
            f"{one.goal} is lost by light alone ({one.why}, {ago(one.at)}): every part in its light is where it was. "
        )
        said += f"`pico optimize {one.goal}` seeks it; `pico verify --measure` tells which part is suspected."
    mark = paint("red", "✗") if one.lost else paint("yellow", "?")
    first, *more = wrap(said, "    ")
    return [f"  {mark} {first.strip()}", *more]


def _hint(found: Drifted) -> str:
    beyond, head = found.beyond, found.head
    held = [d.change.component for d in beyond if d.presence == "held"]
    unseen = [d.change.component for d in beyond if d.change.tunable == "pose" and d.change.after is None]
    lost = [name for name in unseen if name not in held]
    by_hand = {d.change.component: d.by_hand for d in beyond if d.by_hand and d.change.component not in unseen}
    referring = [d.change for d in beyond if is_reference(d.change.before)]
    goals = (reference_from_json(c.before).goal(f"{c.component}.{c.tunable}") for c in referring)
    by_light = [f"`pico optimize {goal}`" for goal in dict.fromkeys(goals)]
    rest = len([d for d in beyond if not d.by_hand]) - len([name for name in unseen if name not in by_hand])
    rest -= len(referring)
    hints = []
    if by_hand:
        why = ", ".join(f"{name} ({said})" for name, said in by_hand.items())
        hints.append(f"Only a person can bring back {why}; `pico capture` keeps what is.")
        if rest > 0:
            hints.append(f"`pico apply {head}` brings back the rest after that.")
    elif rest > 0:
        them = "it" if len(beyond) == 1 else "the rest" if by_light else "them"
        hints.append(f"`pico apply {head}` brings {them} back; `pico capture` keeps what is.")
    if by_light:
        hints.append(f"{listed(by_light)} finds what is to stand where light says.")
    if held:
        hints.append(f"`pico recover` sets down what a gripper holds: {listed(held)}.")
    if lost:
        hints.append(f"What nobody sees, or not surely, only you can put right: {listed(lost)}.")
    return "\n".join(hints)


def _ordered(found: Sequence[Drift]) -> list[Drift]:
    return sorted(found, key=lambda d: d.change.tunable != "pose")


def _entry(one: Drift) -> list[str]:
    return [*lines([one.change]), *(paint("dim", line) for line in wrap(about(one), "      "))]


def about(one: Drift) -> str:
    """Return `tolerance 0.5 mm, 0.5°; seen to 0.02 mm 2 s ago; moved by hand; last placed by run R, TIME`."""
    words = [] if one.tolerance == "none" else [f"tolerance {one.tolerance}"]
    seen = one.uncertainty
    sure = f" to {seen.position:.2g} mm, {seen.yaw:.2g}°" if seen and (seen.position or seen.yaw) else ""
    if sure or one.age >= 1:
        words.append(f"seen{sure}" + (f" {one.age:.0f} s ago" if one.age >= 1 else ""))
    said = {"operation": "by an operation: ", "person": "moved by hand; ", "unknown": "cause unknown; "}
    return "; ".join([*words, (said[one.by] + one.how).rstrip(":; ")])


def data(found: Drifted, bench: str) -> dict[str, Any]:
    """Return schema `pico.drift/v1`: `bench`, `head`, `changes` (from committed, `before`, to live, `after`;
    `tolerance`, `age`, `uncertainty`, `by`, `how`), `ignored`, `held`, `cut_short`, `light`: goals whose light is lost,
    or may be, with what `moved`; `unread`: values that no device of the bench reads; `unstated`: settings that HEAD
    does not name."""
    changes = [entry(d) for d in (*found.beyond, *found.within)]
    own = {
        "bench": bench,
        "head": found.head,
        "observed_at": found.observed_at,
        "ignored": list(found.ignored),
        "held": found.held,
    }
    own |= {"cut_short": as_json(found.cut_short), "light": as_json(found.light or ()), "unread": list(found.unread)}
    own |= {"unstated": as_json(found.unstated)}
    return {"schema": "pico.drift/v1", **own, "changes": changes}


def entry(one: Drift) -> dict[str, Any]:
    """Return one change as JSON data."""
    rest = as_json(one)
    return {**rest.pop("change"), **rest}
