"""`teleop: p2`: a person steers a component by the keys of the terminal, and ends with q."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.diagnostics import ExitCode, PicoError, did_you_mean, error
from pico.manifest.text.tree import Node, Scalar
from pico.model.plan import Plan
from pico.recipes.doing import Doing, alone
from pico.recipes.reader import Reader
from pico.recipes.registry import Given, Kind
from pico.recipes.scope import Scope

KIND = Kind("a person steers a component by keys", "teleop: p2.pose", asks="keys")


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    component, _, tunable = (body.text if isinstance(body, Scalar) else "").partition(".")
    if reader.component(body, component) and tunable:
        able = ("pose", *reader.setup.type_of(component).tunables)
        if tunable not in able:
            hint = did_you_mean(tunable[:40], able) or f"it has: {', '.join(able)}"
            reader.wrong(body, "unknown-tunable", f"{component} has no `{tunable[:40]}` to be steered", hint)
    return Given({"component": component, "tunable": tunable})


def plan(doing: Doing, given: Mapping[str, Any]) -> Plan:
    """Return what would be steered."""
    return doing.bench.plans.to_steer(given["component"], given["tunable"] or None)


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    from pico.bench.teleoperation import Teleoperation

    if not doing.attended:
        raise alone(f"steer {given['component']}")
    planned = plan(doing, given).for_recipe(doing.recipe, doing.step)
    if planned.exit_code:
        raise PicoError([d for d in planned.diagnostics if d.severity == "error"], planned.exit_code)
    jog = Teleoperation(doing.bench, planned)
    doing.steer(jog)
    if jog.report.exit_code:
        wrong = [d for d in jog.report.diagnostics if d.severity == "error"]
        raise PicoError(wrong or [error("failed", f"{given['component']} was not steered to its end")],
                        ExitCode(jog.report.exit_code))  # fmt: skip
    return {}
