"""Another specimen in the housing of a part."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .style import place

if TYPE_CHECKING:
    from pico.bench.updating import Swap


def text(found: Swap, *, done: bool) -> str:
    """Return what changes in lab.yaml, and which parameters stay as they were."""
    if found.same:
        return f"{found.name} has {found.after} already: nothing changes."
    lines = [f"{found.name}: serial {found.before or 'none'} → {found.after}", "", found.patch.rstrip("\n")]
    if found.stays:
        said = ", ".join(f"{name} {place(value)}" for name, value in found.stays.items())
        lines += ["", f"It keeps {said}, as nobody gave another: `--parameter KEY=VALUE` does."]
    return "\n".join(lines)


def data(found: Swap, *, done: bool) -> dict[str, Any]:
    """Return schema `pico.swap/v1`: `component`, serials `before` and `after`, `patch`, what `stays`, and whether it is
    `done`."""
    return {
        "schema": "pico.swap/v1", "component": found.name, "before": found.before, "after": found.after,
        "patch": found.patch, "stays": dict(found.stays), "done": done,
    }  # fmt: skip
