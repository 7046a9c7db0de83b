"""What must hold before the first operation of a plan starts."""

from __future__ import annotations

from collections.abc import Iterator

from pico.backends.device import Capabilities
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.execution.stale import require_fresh, stale
from pico.kernels.pipeline import source_of
from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.plan import Plan
from pico.model.pose import Pose, angle_between
from pico.model.setup import Setup


def require_applicable(plan: Plan, able: Capabilities) -> None:
    """Raise PicoError where `plan` must not be executed by this backend, saying everything that is in the way.

    Exit codes: IMPOSSIBLE for a plan with errors (DENIED where the beam audit alone has any), STALE for another lab,
    else ERROR.
    """
    if plan.errored:
        raise PicoError([d for d in plan.diagnostics if d.severity == "error"], plan.exit_code)
    if plan.lab.digest != able.lab_digest:
        raise PicoError(stale("", "the lab or its component types were edited since"), ExitCode.STALE)
    require_able(plan, able)


def require_able(plan: Plan, able: Capabilities) -> None:
    """Raise PicoError where a plan asks for what this backend can't do."""
    found = list(_missing(plan, able))
    if found:
        raise PicoError(found)


def require_allowed(setup: Setup, plan: Plan, seen: Observation) -> None:
    """Raise PicoError (exit code DENIED) where a mandatory rule of the lab does not hold of `plan` on the bench as it
    is now, it lets light out that nobody lets, or the beam audit refuses it; and where the state expects what makes no
    sense."""
    from pico.planning.checks.emission import require_licensed
    from pico.policy.audit import require_safe

    if plan.target.expect and not plan.target.scope:
        from pico.policy.expectations import require_expressions

        require_expressions(setup, [one.that for one in plan.target.expect])
    require_licensed(setup, seen, plan.operations)
    require_safe(setup, plan, seen)
    if setup.lab.policy.rules:
        from pico.policy import rules

        rules.require_allowed(setup, plan, seen)


def _missing(plan: Plan, able: Capabilities) -> Iterator[Diagnostic]:
    if plan.backend != able.name:
        text = f"this plan was made for the bench `{plan.bench or plan.backend}`, and this is `{able.name}`"
        yield error("backend", text, hint=f"plan again with `--bench {able.name}`")
    elif plan.fidelity != able.fidelity:
        text = f"the plan was made for {plan.fidelity}, and this bench is served in {able.fidelity}"
        yield error("fidelity", text, hint=f"plan again with `--fidelity {able.fidelity}`")
    for op in plan.operations:
        if op.kind.by_hand:
            yield _for_a_person(op, able)
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


def _for_a_person(op: Operation, able: Capabilities) -> Diagnostic:
    what, by_hand = op.arguments.get("text") or f"only a person can move {op.component}", "do it by hand"
    if able.simulated and "from" in op.arguments:
        start, goal = (Pose(**op.arguments[key]["pose"]) for key in ("from", "to"))
        by = {"dx": goal.x - start.x, "dy": goal.y - start.y, "dyaw": angle_between(start.yaw, goal.yaw)}
        words = " ".join(f"--{key} {value:.10g}" for key, value in by.items() if round(value, 6))
        by_hand = f"the hand of the simulated bench is `pico sim nudge {op.component} {words}`"
    hint = f"{by_hand}, then plan again; `--exclude {op.component}` does the rest without it"
    return error("operator", f"{op.component} needs a person: {what}", hint=hint, address=op.component)


def require_current(setup: Setup, plan: Plan, seen: Observation) -> None:
    """Raise PicoError (exit code STALE) where the bench is not any more as `plan` assumes, saying what moved and by
    how much. A part that is to be picked must stand where the plan picks it, within its tolerance, slot or not."""
    require_fresh(setup, plan, seen)
    found = list(_moved(setup, plan, seen))
    if found:
        raise PicoError(found, ExitCode.STALE)


def _moved(setup: Setup, plan: Plan, seen: Observation) -> Iterator[Diagnostic]:
    checked = set()
    for op in plan.operations:
        if not op.kind.carries or op.component in checked:
            continue
        checked.add(op.component)
        part, start = seen.components.get(op.component), Pose(**op.arguments["from"]["pose"])
        if part is None or part.pose is None or op.component not in setup.lab.inventory:
            yield stale(op.component, f"{op.component} is not on the table")
            continue
        hand = seen.robots[op.robot].holding if op.robot and op.robot in seen.robots else None
        if bool(op.arguments["from"].get("held")) != (hand == op.component):
            yield stale(op.component, f"{op.robot} holds {hand or 'nothing'}")
            continue
        tolerance = setup.type_of(op.component).pose.tolerance
        away, turned = part.pose.distance(start), abs(angle_between(start.yaw, part.pose.yaw))
        if away > tolerance.position or turned > tolerance.yaw:
            yield stale(op.component, f"{op.component} was moved by {away:.3g} mm and {turned:.3g}° from {start}")
