"""The plan: the physical diff compiled into a directed acyclic graph of operations, as data."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import field, replace
from typing import Any, Literal

from pico.base.formats import Document, Format
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.model.diff import Change
from pico.model.operation import Operation
from pico.model.record import as_json, canonical, digest, record, remembered
from pico.model.shown.html import table
from pico.model.state import Expectation, LabState, state_from_json

FORMAT = Format("pico.plan")
AUDIT = "beam-audit"
"""The code of what the beam audit tells: a plan is denied for it, though nothing physical is in its way."""
UNARMED = "unarmed"
"""The same of light that nobody lets out."""
DOSE = "dose"
"""The same of light that a sample must not have any more."""


@remembered
def _state_of(data: Mapping[str, Any], lab: str) -> LabState:
    return state_from_json(lab, data)


@record
class LabRef:
    """The lab that a plan was made for."""

    name: str
    digest: str


@record
class Base:
    """What a plan starts from: the commit checked out, and the live state as it was observed."""

    commit: str | None = None
    observed_at: str = ""
    state: Mapping[str, Any] = field(default_factory=dict)


@record
class Target:
    """What a plan leads to: a revision and its commit, or the manifest in the working tree (no revision).

    `title`: what it is where it is neither (the bench before a run). `only`: the components and tunables (`p2`,
    `p1.angle`) that were asked for; `exclude`: those that were to be left alone. None for a whole plan. `expect`: what
    is expected of the bench then. `cause`: why it was made, where not for itself (`checkout`, `undo`, `redo`,
    `recover`, `heal`; `single`: for one operation that somebody asked for; `teleoperation`; `recording`, and `recipe`
    without operations: for a run whose operations are asked for while it is open), and `of` which run; `recipe`: of
    which run of a recipe (`NAME@ID`) it is, or is a `step`. `align`: goals that are not aligned then
    are sought at its end.
    """

    revision: str | None = None
    title: str | None = None
    commit: str | None = None
    only: tuple[str, ...] | None = None
    exclude: tuple[str, ...] | None = None
    state: Mapping[str, Any] = field(default_factory=dict)
    expect: tuple[Expectation, ...] | None = None
    cause: str | None = None
    of: str | None = None
    recipe: str | None = None
    step: str | None = None
    align: bool | None = None

    @property
    def name(self) -> str:
        """What a plan leads to, as a person calls it."""
        return self.revision or self.title or "the manifest"

    @property
    def scope(self) -> str:
        """`only p2`, `without p1`, or nothing for a whole plan."""
        words = [f"only {_listed(self.only)}"] if self.only else []
        return ", ".join([*words, *([f"without {_listed(self.exclude)}"] if self.exclude else [])])


def _listed(names: tuple[str, ...]) -> str:
    return f"{', '.join(names[:-1])} and {names[-1]}" if len(names) > 1 else names[0]


@record
class Staging:
    """How many components are put down on the way, the least number possible as far as it is known, and whether that
    is proven."""

    count: int = 0
    lower_bound: int = 0
    proven: bool = False


BlockingKind = Literal["bodies", "fingers", "storage", "stays", "reach", "path"]


@record
class Blocking:
    """A constraint that keeps a plan from being: of what is `kind`, on component `of`, because of `by`.

    `bodies`: `of` and `by` can't stand where they would meet; `fingers`: those around `of` would touch `by`; `storage`:
    `of` must be in a place for storage while it is on its way; `stays`: what stays, keep-outs, edges or the rim of a
    slot are where `of` or the fingers around it would be; `reach`: no arm picks or places `of` there, or its cable is
    too short; `path`: arms have no free path.
    """

    kind: BlockingKind
    of: str
    by: str = ""


@record
class Spoiled:
    """A goal to be aligned again after a plan: one that is aligned and will not be, or that is not, and whose tunables
    the plan leaves where light had them. `why`; when it was met (`at`, by the wall, empty if it never was); the
    `seconds` that it takes to be sought again."""

    goal: str
    why: str
    at: str = ""
    seconds: float = 0.0


@record
class Plan:
    """Operations that make the live state equal to the target's, in an order that never collides.

    `operations` is sorted by start; arms take theirs in this order. `makespan` [s]; `bound`: before that no order of
    these operations ends [s], where the arms tell how long they take. `spoils`: goals that it leaves unaligned, in the
    order along the beam in which they are to be redone. `blocking`: of a plan that is impossible for its order of
    moves, constraints that no order keeps, as few as are enough. `errored` where the diagnostics hold an error:
    then the plan must not be applied. `backend`: the device that it is for, and so the bench of this machine;
    `bench`: that of a coordinator. `unread`: tunables, by address, that the target gives a value and that no device of
    the bench read, so that they are compared with nothing; None for none.
    """

    schema: str = FORMAT.schema
    digest: str = ""
    lab: LabRef
    calibration: str | None = None
    backend: str
    fidelity: str
    base: Base
    target: Target
    changes: tuple[Change, ...] = ()
    operations: tuple[Operation, ...] = ()
    staging: Staging = Staging()
    makespan: float = 0.0
    bound: float | None = None
    policy: tuple[Mapping[str, Any], ...] = ()
    spoils: tuple[Spoiled, ...] | None = None
    blocking: tuple[Blocking, ...] | None = None
    bench: str | None = None
    unread: tuple[str, ...] | None = None
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def base_state(self) -> LabState:
        """The state that it starts from, read once however often it is asked for."""
        return _state_of(self.base.state, self.lab.name)

    @property
    def target_state(self) -> LabState:
        """The state that it leads to, read once however often it is asked for."""
        return _state_of(self.target.state, self.lab.name)

    def _unread(self) -> tuple[str, ...] | None:
        live, told = self.base_state.components, {f"{c.component}.{c.tunable}" for c in self.changes}
        wanted = {f"{n}.{t}" for n, part in self.target_state.components.items() if n in live
                  for t in part.values.keys() - live[n].values.keys()}  # fmt: skip
        return tuple(sorted(wanted - told)) or None

    @property
    def errored(self) -> bool:
        return any(d.severity == "error" for d in self.diagnostics)

    @property
    def exit_code(self) -> ExitCode:
        """Why the plan can't be run, or DONE."""
        if any(d.severity == "error" and d.code not in (AUDIT, UNARMED, DOSE) for d in self.diagnostics):
            return ExitCode.IMPOSSIBLE
        return ExitCode.DENIED if self.errored or self.denied else ExitCode.DONE

    @property
    def denied(self) -> bool:
        """Whether a mandatory rule of the lab's policy does not hold: then nothing may move."""
        return any(not rule.get("holds") and rule.get("level") == "mandatory" for rule in self.policy)

    @property
    def absent(self) -> tuple[str, ...]:
        """Components that the target names and nobody saw standing: the bench can't equal the target without them.
        One that a hand sets down first counts as standing."""
        held = {op.component for op in self.operations if op.reason.kind == "held"}
        return tuple(sorted(self.target.state.keys() - self.base.state.keys() - held))

    @property
    def unsure(self) -> tuple[str, ...]:
        """Components of which nobody can say that they are as the target wants them, though they were seen."""
        return tuple(sorted({d.address for d in self.diagnostics if d.code in ("uncertain", "held", "toppled")}))

    @property
    def reached(self) -> bool:
        """Whether the bench, as it was observed, equals the target already; of a plan for some components, these. Light
        that is asked for is no part of that, though a plan may bring it."""
        asked = {(c.component, c.tunable) for c in self.changes if c.requested}
        rest = [op for op in self.operations if (op.component, op.arguments.get("tunable")) not in asked]
        if rest or self.absent or self.errored or any(c.counts for c in self.changes):
            return False
        return bool(self.target.scope) or not self.unsure

    @property
    def asked(self) -> bool:
        """Whether it is of single operations that somebody asked for, not of a state."""
        kinds = {op.reason.kind for op in self.operations}
        return (self.target.cause == "single" or "asked" in kinds) and kinds <= {"asked", "parked", "interlock", "held"}

    @property
    def open(self) -> bool:
        """Whether a run of it is open: it has no operations, they are asked for while it goes on."""
        return self.target.cause in ("recording", "recipe") and not self.operations

    def __repr__(self) -> str:
        count = f"{len(self.operations)} operation{'' if len(self.operations) == 1 else 's'}"
        return f"<plan to {self.target.name}: {'impossible' if self.errored else f'{count}, {self.makespan:.1f} s'}>"

    def _repr_html_(self) -> str:
        rows = [(c.component, c.tunable, c.text) for c in self.changes]
        below = "; ".join(f"{d.severity}: {d.summary}" for d in self.diagnostics)
        return table(repr(self)[1:-1], ("part", "tunable", "change"), rows, below)

    def because(self, cause: str, of: str | None = None) -> Plan:
        """Return the plan, sealed, with why it was made: see `Target`."""
        return replace(self, target=replace(self.target, cause=cause, of=of)).sealed()

    def for_recipe(self, recipe: str, step: str) -> Plan:
        """Return the plan, sealed, as that of a step of a recipe: see `Target`."""
        return replace(self, target=replace(self.target, cause="recipe", recipe=recipe, step=step)).sealed()

    def with_ids(self, prefix: str) -> Plan:
        """Return the plan, not sealed, with something in front of the ids of its operations."""
        new = {op.id: f"{prefix}{op.id}" for op in self.operations}
        found = (replace(op, id=new[op.id], after=tuple(new[a] for a in op.after)) for op in self.operations)
        return replace(self, operations=tuple(found))

    def sealed(self) -> Plan:
        """Return the plan with its digest set."""
        found = replace(self, unread=self._unread())
        return replace(found, digest=_digest(as_json(found)))

    def to_json(self) -> str:
        """Return the plan as canonical JSON, as `pico plan --out` writes it."""
        return canonical(self)


def _digest(content: Document) -> str:
    """Return the digest of a plan's document, whatever its version; it leaves out itself and when it was observed."""
    base = {k: v for k, v in content["base"].items() if k != "observed_at"}
    return digest({**content, "digest": "", "base": base})


def plan_from_json(text: str | bytes) -> Plan:
    """Return the plan that `Plan.to_json` wrote, in this version of the format or an older one; raises PicoError where
    it is none, or was changed since."""
    from pydantic import TypeAdapter, ValidationError

    try:
        written = json.loads(text)
        content = FORMAT.lifted(written)
    except ValueError as exc:
        raise PicoError(error("plan-file", f"the saved plan cannot be read: it is {exc}")) from exc
    try:
        plan: Plan = TypeAdapter(Plan).validate_python(content)
    except ValidationError as exc:
        first = exc.errors()[0]
        where = ".".join(str(word) for word in first["loc"])
        raise PicoError(
            error("plan-file", f"this is no saved plan: {where + ': ' if where else ''}{first['msg']}")
        ) from exc
    if plan.digest != _digest(written):
        raise PicoError(
            error("plan-file", "this plan was changed after it was saved: its digest does not fit", hint="plan again")
        )
    return replace(plan, unread=plan._unread()) if "unread" not in written else plan
