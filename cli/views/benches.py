"""The benches of coordinators, and who has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from .style import columns, count, inert, paint

if TYPE_CHECKING:
    from pico.edge.network.remotes import Far

Found = Mapping[str, Sequence[Mapping[str, Any]]]
"""What each remote has."""


def text(found: Found, meant: Far | None) -> str:
    """Return a line a bench, that which commands mean marked."""
    if not found:
        return "This checkout knows no coordinator: `pico remote add NAME URL`."
    rows = [
        ["*" if meant and meant.name == one["bench"] else " ", remote, inert(str(one["bench"])), _state(one)]
        for remote, benches in found.items()
        for one in benches
    ]
    if not rows:
        return "No benches that you may see. An admin enrols one (`pico token enrol LAB/BENCH`), and gives roles."
    last = "Commands mean the one marked *." if meant else "`pico bench use LAB/BENCH` lets commands mean one of them."
    return "\n".join([*columns(rows), last])


def _state(one: Mapping[str, Any]) -> str:
    if one.get("connected") is False:
        return paint("red", "its edge is away")
    lease = one.get("lease") or {}
    holder, waiting = lease.get("holder"), lease.get("waiting") or ()
    queue = f", {count(len(waiting), 'more waits', 'more wait')}" if waiting else ""
    return inert(f"{holder['who']} has it{queue}") if holder else "free"


def data(found: Found, meant: Far | None) -> dict[str, Any]:
    """Return schema `pico.benches/v1`: of each of the `benches` its `remote`, `bench`, `holder` and who is `waiting`,
    whether it is `connected`; `meant`."""
    benches = [
        {
            "remote": remote, "bench": one["bench"], "holder": (one.get("lease") or {}).get("holder"),
            "waiting": (one.get("lease") or {}).get("waiting", []), "connected": one.get("connected"),
        }
        for remote, several in found.items()
        for one in several
    ]  # fmt: skip
    return {"schema": "pico.benches/v1", "benches": benches, "meant": meant.name if meant else None}
