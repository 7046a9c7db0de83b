"""What the journal keeps of a run besides its plan: who ran it and with what, and how the bench was seen afterwards."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from pico.backends.device import Capabilities
from pico.edge.lease import user
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.trace.expectation import Expected
from pico.version import __version__

STANDS_ON = ("mujoco", "numpy", "ruckig")
"""Packages whose version may change how something moves."""


def about_run(setup: Setup, plan: Plan, able: Capabilities) -> dict[str, Any]:
    """Return what is kept when a run begins: `cause`, `evidence`, `operator`, `seed`, `environment`, `versions`."""
    return {
        "cause": cause_of(plan),
        "evidence": able.evidence,
        "operator": user(),
        **({"seed": setup.lab.sim.seed} if able.simulated else {}),
        "environment": {"backend": able.name, "fidelity": able.fidelity, "system": _system()},
        "versions": _versions(),
    }


def cause_of(plan: Plan) -> dict[str, str]:
    """Return the `kind` of what a plan was made for, and `of` which run; see `pico.model.trace.run.Cause`."""
    if plan.target.cause:
        more = {"of": plan.target.of, "recipe": plan.target.recipe, "step": plan.target.step}
        return {"kind": plan.target.cause, **{key: value for key, value in more.items() if value}}
    return {"kind": "single" if plan.asked else "apply"}


def seen_after(seen: Observation, expectations: tuple[Expected, ...], *, reached: bool) -> dict[str, Any]:
    """Return what is kept when a run is over: the components as observed, the expectations of its goal, and whether the
    whole of that was `reached`."""
    return {
        "at": seen.observed_at,
        "components": as_json(seen.components),
        "expectations": as_json(expectations),
        "reached": reached,
    }


def _versions() -> dict[str, str]:
    return {"pico": __version__, "python": platform.python_version()} | {
        name: found for name in STANDS_ON if (found := _installed(name))
    }


def _installed(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _system() -> str:
    return f"{platform.system()} {platform.release()} {platform.machine()}"
