"""Whether a bench can do what a plan asks of it: its backend, fidelity, primitives, measurables and robots."""

from __future__ import annotations

from collections.abc import Iterator

from pico.backends.device import Capabilities
from pico.diagnostics import Diagnostic, PicoError, error
from pico.kernels.pipeline import source_of
from pico.model.operation import Operation
from pico.model.plan import Plan


def require_able(plan: Plan, able: Capabilities) -> None:
    """Raise PicoError if a plan asks for what this backend can't do."""
    if found := incapacities(plan, able):
        raise PicoError(found)


def incapacities(plan: Plan, able: Capabilities) -> list[Diagnostic]:
    """Return an error for each thing that a plan asks for and this backend can't do."""
    return list(_missing(plan, able))


def _missing(plan: Plan, able: Capabilities) -> Iterator[Diagnostic]:
    if plan.backend != able.name:
        text = f"this plan was made for the bench `{plan.bench or plan.backend}`, and this is `{able.name}`"
        yield error("backend", text, hint=f"plan again with `--bench {able.name}`")
    elif plan.fidelity != able.fidelity:
        text = f"the plan was made for {plan.fidelity}, and this bench is served in {able.fidelity}"
        yield error("fidelity", text, hint=f"plan again with `--fidelity {able.fidelity}`")
    for op in plan.operations:
        if op.kind.by_hand and op.primitive not in able.primitives:
            yield _for_a_person(op)
        elif op.primitive not in able.primitives:
            text = f"{able.name} ({able.fidelity}) cannot {op.primitive} {op.component}"
            yield error("capability", text, detail=f"{op.id} of the plan asks for it", address=op.component)
        elif op.primitive == "measure" and source_of(op.address) not in able.measurables:
            yield _unmeasured(op, able)
    for name in sorted({op.robot for op in plan.operations if op.robot} - set(able.robots)):
        here = ", ".join(able.robots) or "none"
        yield error("capability", f"the plan needs the robot {name}; {able.name} has: {here}")


def _unmeasured(op: Operation, able: Capabilities) -> Diagnostic:
    own = sorted(a.partition(".")[2] for a in able.measurables if a.partition(".")[0] == op.component)
    blind = (
        "no camera over the bench sees it"
        if op.address.endswith(".pose")
        else "the simulator has nothing that measures it"
    )
    why = blind if able.simulated else f"{able.name} has nothing that measures it"
    hint = f"of {op.component} it measures: {', '.join(own)}" if own else ""
    return error("unmeasured", f"{op.address} can't be measured: {why}", hint=hint, address=op.address)


def _for_a_person(op: Operation) -> Diagnostic:
    what, by_hand = op.arguments.get("text") or f"only a person can move {op.component}", "do it by hand"
    rest = "" if op.reason.kind == "asked" else f"; `--exclude {op.component}` does the rest without it"
    hint = f"{by_hand}, then plan again{rest}" if rest else by_hand
    return error("operator", f"{op.component} needs a person: {what}", hint=hint, address=op.component)
