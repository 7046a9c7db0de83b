"""The beam audit of a plan: of the light that it lets out, or leaves on, where it leads to."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import product
from threading import Lock
from typing import Any

from pico.diagnostics import Diagnostic
from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.plan import Plan
from pico.model.pose import Pose, angle_between
from pico.model.record import as_json, digest
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.optics.audit.findings import Audit, Finding, told
from pico.optics.audit.lasers import laser_class, lasers_of, unread_power
from pico.optics.audit.limits import above_class_2
from pico.optics.axis import Values, axis_of
from pico.planning.checks.emission import SEARCHING, lets_out
from pico.policy.beams import open_beams
from pico.policy.driven import driven_in_light, fine_steps, searched_in

CORNERS = 4
"""Of so many tunables that are searched at once the corners that they span are judged, too."""
SCANNED = 5
"""At so many values of what a raster search scans is its light judged; mirrors over all of their range anyway."""


@dataclass(frozen=True)
class Lit:
    """A bench with light on it: where things stand, what they are set to, and the `lasers` that shine at some time;
    `opened`: those of them that a plan lets out; `enclosed`: no beam leaves the enclosure around it."""

    poses: Mapping[str, Pose]
    values: Values
    lasers: tuple[str, ...]
    opened: frozenset[str] = frozenset()
    enclosed: bool = False
    # Between which values a plan drives the angles of mirrors while light may be on, by component and tunable.
    spans: Mapping[str, Mapping[str, tuple[float, float]]] = field(default_factory=dict)


Tracing = Callable[[Setup, Lit], Audit | None]
"""Tells the verdict on a bench; None where nobody knows it yet, and it is not worth finding out."""
VERSION = 3
"""Of the rules of the audit; a verdict by others is not believed."""
MOST = 64
"""So many verdicts stay in memory, the newest."""
_VERDICTS: dict[tuple[str, str], Audit] = {}
_VERDICTS_LOCK = Lock()


def audit_key(setup: Setup, lit: Lit) -> str:
    """Return the digest of all that the verdict on a bench with light on it depends on."""
    return digest([VERSION, setup.digest(), lit.poses, lit.values, lit.lasers, lit.spans])


def judge(setup: Setup, lit: Lit) -> Audit:
    """Return the verdict on a bench with light on it; imports numpy.

    The last verdicts stay in memory, so that the edge of a client in the same process traces no light twice: by every
    digit, as a digest is of rounded numbers. Nothing of that is read from a disk: an edge believes no file of a client.
    """
    key = (setup.digest(), json.dumps(as_json([lit.poses, lit.values, lit.lasers, lit.spans]), sort_keys=True))
    with _VERDICTS_LOCK:  # a client plans in another thread than the edge in its process
        known = _VERDICTS.pop(key, None)
    if known is None:
        from pico.optics.audit.audit import audit

        known = audit(setup, lit.poses, lit.values, lit.lasers, lit.spans)
    with _VERDICTS_LOCK:
        _VERDICTS[key] = known
        while len(_VERDICTS) > MOST:
            del _VERDICTS[next(iter(_VERDICTS))]
    return known


def lit_by(setup: Setup, plan: Plan, seen: Observation) -> Lit:
    """Return the bench that a plan leads to, with all that it lets light out of open.

    What stands within tolerance of where the target wants it counts as there: so the same bench is the same each time.
    """
    wanted = plan.target_state
    poses = {n: _settled(setup, wanted, n, c.pose) for n, c in seen.components.items()
             if c.pose is not None and c.presence == "seen" and n in setup.lab.inventory}  # fmt: skip
    known = {n: {**own, **_maybe_on(setup, seen, n)} for n, own in seen.known_values.items()}
    values = {n: _set(setup, wanted, n, own) for n, own in known.items() if n in setup.lab.inventory}
    opened, scanned = set[str](), False
    lifted = {(op.component, op.arguments.get("tunable")) for op in plan.operations if _opens(setup, op)}
    for op in plan.operations:
        to, tunable = op.arguments.get("to"), op.arguments.get("tunable")
        if isinstance(to, Mapping) and "pose" in to:
            poses[op.component] = Pose(**to["pose"])
        elif op.primitive == "set" and tunable is not None and op.component in setup.lab.inventory:
            own = values.setdefault(op.component, {})
            lets = _opens(setup, op)
            if lets or (op.component, tunable) not in lifted:  # what is open at some time counts as open
                own[str(tunable)] = max(own.get(str(tunable), 0.0), to) if lets and _number(to) else to
            opened |= {op.component} if lets else set()
        scanned |= op.primitive in ("scan", *SEARCHING)
    lasers = lasers_of(setup, poses, values)
    apart = any(setup.type_of(name).optics.element != "source" for name in opened)
    spans, steered = driven_in_light(setup, plan, seen, values, lasers)
    return Lit(poses, values, lasers, frozenset(n for n in lasers if n in opened or apart or scanned or n in steered),
               bool(setup.lab.policy.enclosed), spans)  # fmt: skip


def _opens(setup: Setup, op: Operation) -> bool:
    return op.primitive == "set" and lets_out(setup, op)


def _number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _settled(setup: Setup, wanted: LabState, name: str, pose: Pose) -> Pose:
    """Return where a part is wanted where it stands there within its tolerance, else where it stands."""
    if name not in wanted.components:
        return pose
    goal, tolerance = place_of(setup, wanted, name)[1], setup.type_of(name).pose.tolerance
    near = pose.distance(goal) <= tolerance.position and abs(angle_between(pose.yaw, goal.yaw)) <= tolerance.yaw
    return goal if near else pose


def _set(setup: Setup, wanted: LabState, name: str, own: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tunables of a part, those within their tolerance of what is wanted as wanted."""
    goal = wanted.components[name].values if name in wanted.components else {}
    kinds, found = setup.type_of(name).tunables, dict(own)
    for key, value in own.items():
        target = goal.get(key)
        if key in kinds and _number(value) and _number(target) and abs(value - target) <= kinds[key].tolerance:
            found[key] = target
    return found


def audit_of(setup: Setup, plan: Plan, seen: Observation, judged: Tracing = judge) -> tuple[Audit, Lit]:
    """Return the verdict on the light of a plan, and the bench that it is about; where no laser shines, nothing is
    traced, nor imported for it. What `judged` does not know is left out."""
    if _dark(setup, plan, seen):
        return Audit(lasers={}), Lit({}, {}, ())
    lit = lit_by(setup, plan, seen)
    benches = ((lit, ""), *_scans(setup, plan, lit)) if lit.lasers else ()
    verdicts = [(judged(setup, one), where) for one, where in benches]
    known = [verdict for verdict, _ in verdicts if verdict is not None]
    findings: dict[str, Finding] = {}
    for verdict, where in verdicts:
        for f in verdict.findings if verdict is not None else ():
            findings.setdefault(f.branch, replace(f, searched=where))
    carried = tuple(_carried(setup, plan, seen, lit))
    classes = {n: laser_class(setup, n, lit.values.get(n, {}))[0] for n in lit.lasers}
    unsaid = sorted({name for verdict in known for name in verdict.unjudged})
    return Audit(findings=(*findings.values(), *carried), lasers=classes, unjudged=tuple(unsaid)), lit


def _dark(setup: Setup, plan: Plan, seen: Observation) -> bool:
    """Whether no laser shines before a plan, and it sets none."""
    sources = [n for n in setup.lab.inventory if setup.type_of(n).optics.element == "source"]
    return not (set(sources) & {op.component for op in plan.operations}) and not _shining(setup, seen, sources)


def told_of(plan: Plan, audit: Audit, lit: Lit) -> tuple[Diagnostic, ...]:
    """Return what the audit says of a plan: errors where that opens a laser above class 2, or carries a part by."""
    revision = f" {plan.target.revision}" if plan.target.revision else ""
    drawn = "`pico beam --picture beams.png`" if plan.asked else f"`pico plan{revision} --picture beams.png`"
    carried = {f.source for f in audit.findings if f.kind == "carried" and not lit.enclosed}
    first = [f for f in audit.findings if f.kind == "carried"]
    rest = replace(audit, findings=tuple(f for f in audit.findings if f.kind != "carried"))
    return (
        *told(replace(audit, findings=tuple(first)), refused=frozenset(carried), drawn=drawn),
        *told(rest, refused=frozenset() if lit.enclosed else lit.opened, drawn=drawn),
    )


def _scans(setup: Setup, plan: Plan, lit: Lit) -> Iterator[tuple[Lit, str]]:
    """Yield the bench at values over the range of each tunable that is scanned or searched, or driven in light, and in
    the corners of what several span, each with where that is, in words."""
    driven = {(name, tunable): ends for name, own in lit.spans.items() for tunable, ends in own.items()}
    searched = {**driven, **{(name, tunable): bounds for name, tunable, bounds in searched_in(setup, plan)}}
    for one, (low, high) in searched.items():
        steps = max(SCANNED - 1, fine_steps(setup, *one, low, high) if one in driven else 0)
        for n in range(steps + 1):
            yield _at(lit, {one: low + (high - low) * n / steps})
    if 1 < len(searched) <= CORNERS:
        for ends in product(*searched.values()):
            yield _at(lit, dict(zip(searched, ends, strict=True)))


def _at(lit: Lit, point: Mapping[tuple[str, str], float]) -> tuple[Lit, str]:
    values = {name: dict(own) for name, own in lit.values.items()}
    for (component, tunable), value in point.items():
        values.setdefault(component, {})[tunable] = value
    passed = {component for component, _ in point}
    spans = {name: own for name, own in lit.spans.items() if name not in passed}  # the bench itself is judged over them
    return replace(lit, values=values, spans=spans), ", ".join(
        f"{c}.{t} at {value:.4g}" for (c, t), value in point.items()
    )


def _carried(setup: Setup, plan: Plan, seen: Observation, lit: Lit) -> Iterator[Finding]:
    """Yield a finding for each part that an arm carries while a laser above class 2 may be open: on its way a part may
    reflect a beam anywhere, and nobody can trace that."""
    carrying = [op for op in plan.operations if op.carries]
    sources = [n for n in setup.lab.inventory if setup.type_of(n).optics.element == "source"]
    lasers = sorted({*lit.lasers, *_shining(setup, seen, sources)})
    if not carrying or not lasers:
        return
    opened, told_already = open_beams(setup, plan.operations, seen, lasers), set[tuple[str, str]]()
    for op in carrying:
        for laser in opened[op.id]:
            of, power = laser_class(setup, laser, lit.values.get(laser, {}))
            if not above_class_2(of) or (laser, op.component) in told_already:
                continue
            told_already.add((laser, op.component))
            legs = axis_of(setup, lit.poses, laser, lit.values).legs if laser in lit.poses else ()
            path = tuple((round(x, 2), round(y, 2)) for leg in legs for x, y, _ in (leg.start, leg.end))
            where = f"may be sent anywhere by {op.component} while {op.robot} carries it"
            hint = f"close the shutter of {laser} first; `policy: {{open_beam: true}}` is for lasers up to class 2"
            yield Finding(
                kind="carried", source=laser, laser_class=of, way=(), where=where, component=op.component, power=power,
                limit=None, path=path, hint=hint,
            )  # fmt: skip


def _shining(setup: Setup, seen: Observation, sources: Iterable[str]) -> tuple[str, ...]:
    """Return the lasers among `sources` that shine before a plan begins."""
    there = [n for n in sources if n in seen.components and seen.components[n].presence == "seen"]
    values = {n: {k: v.value for k, v in seen.components[n].values.items() if v.status == "known"} for n in there}
    return lasers_of(setup, there, {n: {**own, **_maybe_on(setup, seen, n)} for n, own in values.items()})


def _maybe_on(setup: Setup, seen: Observation, name: str) -> dict[str, Any]:
    """Return that a laser emits if its emission was not read back, and the highest power that it may have if that was
    not."""
    if name not in setup.lab.inventory or setup.type_of(name).optics.element != "source":
        return {}
    known = {key: live.value for key, live in seen.components[name].values.items() if live.status == "known"}
    switched, most = "emission" in setup.type_of(name).tunables, unread_power(setup, name, known)
    found: dict[str, Any] = {"emission": True} if switched and known.get("emission") is None else {}
    return found if most is None else {**found, "power": most}
