"""Why there is no order of moves: who can't be held, reached or placed, or who blocks whom in a ring."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from pico.diagnostics import Diagnostic, error
from pico.geometry import Grid, fits
from pico.model.catalog import Footprint
from pico.model.plan import Blocking
from pico.planning.checks.free_places import nearest_free, trial_of
from pico.planning.checks.standing import Standing, Standpoint
from pico.planning.checks.target import Source, located
from pico.planning.explaining.alone import alone_refused, no_path
from pico.planning.explaining.certificate import stored_would_do
from pico.planning.explaining.proof import Proof, stuck_of
from pico.planning.explaining.reasons import body_overlap
from pico.planning.ordering.conflicts import Conflicts
from pico.planning.ordering.paths import NoPath
from pico.planning.ordering.solve import OrderedMoves, Refusal
from pico.planning.parts.movers import Mover
from pico.planning.parts.phrases import listed
from pico.staging.feedback.digraph import some_cycle


def explain(refused: Refusal, source: Source, proven: Proof | None = None) -> list[Diagnostic]:
    """Return the errors that say why the movers of a refused problem can't all reach their goals."""
    found = _explained(refused, source, proven)
    doubt = proven.doubt if proven else ""
    return [replace(found[0], detail="\n".join(t for t in (found[0].detail, doubt) if t)), *found[1:]]


def _explained(refused: Refusal, source: Source, proven: Proof | None) -> list[Diagnostic]:
    if len(refused.core) == 1:
        alone = [alone_refused(refused, refused.core[0], source)]
        wide = refused.widest
        if wide and len(wide.core) == 1 and not wide.table.movers[wide.core[0]].right:
            alone.append(alone_refused(wide, wide.core[0], source))  # even where what stands in the way may be moved
        return [one for n, one in enumerate(alone) if one.address not in {a.address for a in alone[:n]}]
    own = proven.own.blocking if proven else None
    if (last := _last_path(refused, own)) is not None:
        return [no_path(refused.table, last, source)]
    movers = refused.table.movers
    stuck = stuck_of(refused)
    if own is not None:
        stuck = [i for i, m in enumerate(movers) if m.name in _named(own)]
    found = _ring(refused.table, stuck, refused, source, own)
    widest = proven.widest.blocking if proven and proven.widest else None
    aside = sorted(_named(widest or ()) - {m.name for m in movers})
    if aside:
        found = replace(found, detail=f"{found.detail}\nto move {listed(aside, 'or')} aside would not help")
    return [found]


def _last_path(refused: Refusal, own: Sequence[Blocking] | None) -> NoPath | None:
    """Return the last path that was blocked, where that alone is what is known: of who has no path, or of anybody."""
    if own is None:
        return refused.blocked[-1] if refused.blocked and not refused.core else None
    named = {c.of for c in own if c.kind == "path"} if len(own) == 1 else set()
    return next((b for b in reversed(refused.blocked) if refused.table.movers[b.step.mover].name in named), None)


def _named(blocking: Sequence[Blocking]) -> set[str]:
    return {name for c in blocking for name in (c.of, c.by)} - {""}


PASSAGE = "make room where the arms pass, or choose other places"


def storage_note(answer: OrderedMoves) -> list[Diagnostic]:
    """Return a note where storage has too little room for as few stagings as there might be."""
    if answer.staged <= answer.least or not answer.slots:
        return []
    more = answer.staged - answer.least
    return [Diagnostic(
        severity="note", code="storage",
        summary=f"{more} more staging move{'s' if more > 1 else ''} than with more room in storage",
        hint=f"with {answer.slots} free slot{'s' if answer.slots > 1 else ''} within reach {answer.least} would do",
    )]  # fmt: skip


def _ring(
    table: Conflicts, stuck: Sequence[int], refused: Refusal, source: Source, blocking: Sequence[Blocking] | None
) -> Diagnostic:
    arcs = {(a, b): text for a in stuck for b in stuck if a != b and (text := before(table, a, b))}
    ring = some_cycle({a: [b for b in stuck if (a, b) in arcs] for a in stuck}) or []
    stored = {c.of for c in blocking or () if c.kind == "storage"}
    paths = {table.movers[b.step.mover].name: b.blocked.text for b in refused.blocked}
    by_path = {c.of for c in blocking if c.kind == "path"} if blocking is not None else set(paths)
    ring = [] if by_path else ring
    ring = ring if blocking is None or {table.movers[i].name for i in ring} == stored else []
    names = [table.movers[i].name for i in (ring or stuck)]
    lines = [arcs[a, b] for a, b in zip(ring, ring[1:] + ring[:1], strict=True)]
    told = blocking if blocking is not None else [Blocking(kind="path", of=name) for name in names if name in paths]
    lines = lines or [line for c in told for line in _lines(table, c, arcs, paths)] or sorted(arcs.values())
    lines += [
        _storage_line(table, i, paths if table.movers[i].name in by_path else {}) for i in (ring or stuck)
        if blocking is None or table.movers[i].name in stored
    ]  # fmt: skip
    if ring:
        summary = f"{listed(names)} block one another in a ring that no storage slot breaks"
    elif blocking is not None and not stored:
        summary = f"{listed(names)} are in one another's way in any order, and storage would not help"
    elif refused.proven or blocking is not None:
        summary = f"{listed(names)} can't all reach their places in any order"
    else:
        summary = f"found no order in which {listed(names)} reach their places, within the limit of the search"
    first = names[0] if names else ""
    hint = PASSAGE if by_path else _room(table, names, refused.slots, blocking)
    return error(
        "impossible", summary, detail="\n".join(lines), hint=hint,
        address=f"{first}.pose", source=located(source, table.movers[stuck[0]]) if stuck else None,
    )  # fmt: skip


def _room(table: Conflicts, names: Sequence[str], slots: int, blocking: Sequence[Blocking] | None) -> str:
    """Return what would help: more storage only where that is what lacks."""
    stored = {c.of for c in blocking or () if c.kind == "storage"}
    if blocking is not None and not (stored and stored_would_do(table, stored)):
        fingers = any(c.kind == "fingers" for c in blocking)
        return "leave more room between them" + (" for the fingers, or give their types other grasp yaws" * fingers)
    setup, waits = table.setup, [n for n in names if blocking is None or n in stored]
    inventory, by_hand = setup.lab.inventory, [name for name in waits if not setup.movable(name)]
    if by_hand and len(by_hand) == len(waits):
        return _put_aside(table, by_hand)
    allowed = [name for name in names if inventory[name].stage == "never"]
    if waits and set(waits) <= set(allowed):
        return f"allow staging of {listed(waits, 'or')}, with one slot free within reach"
    enough = f"{slots} slots within reach that take them" if slots > 1 else "one slot within reach"
    if allowed and len(allowed) < 6:
        return f"free {enough}, or allow staging of {listed(allowed, 'or')}"
    return f"free {enough}, or leave more room between them"


ROOM = 60.0
"""How far from all else a person puts a part down for now [mm]: fingers have room between them."""


def _put_aside(table: Conflicts, names: Sequence[str]) -> str:
    """Return which of some parts that only people move can be put aside for now, and where: clear of everybody at
    start and goal."""
    ends = {n: Standpoint(n, o.shape, False, o.height) for n, o in table.obstacles.items()}
    for i, mover in enumerate(table.movers):
        for p in (0, *mover.goals):
            ends[f"{mover.name} {p}"] = Standpoint(mover.name, table.shape(i, p), True, mover.geometry.height)
    standing, trial = Standing(ends, Grid.of({key: end.shape for key, end in ends.items()})), trial_of((), (), None)
    for mover in (m for name in names for m in table.movers if m.name == name):
        here, radius = replace(mover, goals=(0,)), mover.geometry.footprint.radius
        roomy = replace(here, geometry=replace(mover.geometry, footprint=Footprint(disc=radius + ROOM)))
        if free := nearest_free(table.setup, roomy, standing, trial) or nearest_free(
            table.setup, here, standing, trial
        ):
            name, (x, y) = mover.name, free
            where = f"at x = {x:g}, y = {y:g} for now (`pico move {name} x={x:g} y={y:g}`)"
            return f"put {name} {where}, then plan again"
    return f"take {names[0]} off the table for now, then plan again"


def _lines(
    table: Conflicts, c: Blocking, arcs: Mapping[tuple[int, int], str], paths: Mapping[str, str]
) -> list[str]:  # fmt: skip
    """Return a constraint in words, a path with what was in its way; what lacks in storage is told by itself."""
    known = [text for pair, text in sorted(arcs.items()) if {table.movers[i].name for i in pair} == {c.of, c.by}]
    if c.kind == "bodies":
        return known or [f"{c.of} and {c.by} have no room to pass one another"]
    told = {
        "fingers": f"the fingers around {c.of} would touch {c.by}",
        "stays": f"what stays is where {c.of}, or the fingers around it, would be",
        "reach": f"no arm reaches {c.of} in every hold",
        "path": f"arms have no free path for {c.of}" + (f": {paths[c.of]}" if c.of in paths else ""),
    }
    return [told[c.kind]] if c.kind in told else []


def before(table: Conflicts, a: int, b: int) -> str:
    """Return why mover `a` must leave before the direct move of mover `b`, in words; empty where it need not."""
    first, second = table.movers[a], table.movers[b]
    bit = table.bit(a, 0)
    masks = [w.mask for g in second.goals for w in table.ways(b, 0, g)]
    bodies = [table.arrive(b, g) or 0 for g in second.goals]
    if not all(m & bit for m in masks) or (not masks and not all(m & bit for m in bodies)):
        return ""
    depth = max(body_overlap(table, (b, g), (a, 0)) for g in second.goals)
    if all(m & bit for m in bodies) and -depth > table.setup.lab.margins.body:
        how = f"it stands in the mouth of {second.goal.slot}" if second.goal.slot else "it is in the slot covered then"
    elif all(m & bit for m in bodies):
        how = f"bodies overlap by {depth:.3g} mm" if depth > 0 else f"bodies come within {-depth:.3g} mm"
    else:
        how = f"a finger of the gripper would touch {first.name}, every grasp yaw tried"
    return f"{first.name} must leave before {second.name} arrives ({how})"


def _storage_line(table: Conflicts, i: int, paths: Mapping[str, str]) -> str:
    """Return why a component can't be put down in storage meanwhile; `paths`: what was in the way of arms."""
    mover = table.movers[i]
    if table.setup.lab.inventory[mover.name].stage == "never":
        return f"{mover.name}: stage: never"
    if not mover.holds or mover.holds[0].robot is None:
        return f"{mover.name}: only a person can move it"
    if not any(fits(slot, mover.geometry.footprint) for slot in table.setup.lab.slots.values()):
        return f"{mover.name}: no slot takes it"
    free = [p for p in mover.staging if table.arrive(i, p) is not None]
    if not free:
        return f"{mover.name}: {_no_room(table, i)}"
    held = [p for p in free if any(table.grip(i, p, h) is not None for h in mover.holds)]
    slots = sorted({mover.places[p].slot or "" for p in held or free})
    if not held:
        why = _first_reach(table, i, free, mover)
        return f"{mover.name}: the free slots {listed(slots)} are {why}"
    needed = f"{listed(slots)} would take it, but others need {'it' if len(slots) == 1 else 'them'} too"
    pathless = f"arms have no free path to {listed(slots, 'or')}, or none from there"
    return f"{mover.name}: {pathless if mover.name in paths else needed}"


def _no_room(table: Conflicts, i: int) -> str:
    """Return why a component can stand in none of the slots that take it."""
    mover, margin = table.movers[i], table.setup.lab.margins.body
    slots = sorted({mover.places[p].slot or "" for p in mover.staging})
    if not slots:
        return "every slot that takes it is occupied"
    near = sorted({name for p in mover.staging for name in table.static.conflicts(table.shape(i, p), margin)})
    covered = sorted({slot for p in mover.staging for slot in table.covered_in_use(i, p)})
    if near:
        why = f"it would come too near to {listed(near, 'or')}"
    elif covered:
        why = f"it would cover the mouth of {listed(covered, 'or')}, in which something stays"
    else:
        why = "it would reach over the edge or into a keep-out"
    return f"in {listed(slots, 'or')} {why}"


def _first_reach(table: Conflicts, i: int, places: Sequence[int], mover: Mover) -> str:
    reach = any(table.unreachable(i, p, h) for p in places for h in mover.holds)
    return "out of reach" if reach else "without room for the fingers"
