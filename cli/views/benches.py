"""The benches of this machine and of coordinators, and who has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from pico.edge.network.meant import word_for

from .style import ago, columns, count, inert, paint

if TYPE_CHECKING:
    from pico.edge.network.remotes import Place
    from pico.history.runs.benches import BenchState

Found = Mapping[str, Sequence[Mapping[str, Any]]]
"""What each remote has."""


def text(local: Sequence[BenchState], found: Found, meant: Place) -> str:
    """Return a line a bench, that which commands mean marked."""
    rows = [line(one, meant=word_for(meant) == one.bench) for one in local]
    lines = ["Benches of this machine", *columns(rows, indent="  ")]
    far = [
        [
            "*" if word_for(meant) == f"{remote}/{one['bench']}" else " ",
            f"{remote}/{inert(str(one['bench']))}",
            _state(one),
        ]
        for remote, benches in found.items()
        for one in benches
    ]
    if far:
        lines += ["", "Benches of coordinators", *columns(far, indent="  ")]
    elif found:
        seen = "No benches of coordinators that you may see."
        lines += ["", f"{seen} An admin enrols one (`pico token enrol LAB/BENCH`), and gives roles."]
    return "\n".join([*lines, "", "Commands mean the one marked *; `pico bench use NAME` chooses another one."])


def line(one: BenchState, *, meant: bool) -> list[str]:
    """Return the cells of a bench of this machine."""
    where = ""
    if one.attached and not one.here:
        where = f"attached to {one.attached}"
    said = [f"last run {one.last}, {ago(one.began, waits=one.waits)}" if one.last and one.began else "no runs"]
    said += [paint("yellow", count(one.pending, "run") + " not committed")] if one.pending else []
    said += [where] if where else []
    said += [f"in use by {inert(one.holder.said)}"] if one.holder else []
    return ["*" if meant else " ", one.bench, "; ".join(said)]


def _mark(meant: Place, word: str) -> str:
    return "*" if word_for(meant) == word else " "


def _state(one: Mapping[str, Any]) -> str:
    if one.get("connected") is False:
        return paint("red", "its edge is away")
    lease = one.get("lease") or {}
    holder, waiting = lease.get("holder"), lease.get("waiting") or ()
    queue = f", {count(len(waiting), 'more waits', 'more wait')}" if waiting else ""
    return inert(f"{holder['who']} has it{queue}") if holder else "free"


def data(local: Sequence[BenchState], found: Found, meant: Place) -> dict[str, Any]:
    """Return schema `pico.benches/v1`: of each bench of coordinators (`benches`) its `remote`, `bench`, `holder` and
    who is `waiting`, whether it is `connected`; of each of this machine (`local`) its `bench`, `holder`, how many runs
    are `pending`, the `last` run and when it `began`, and where it is `attached`; `meant`, as `--bench` takes it."""
    benches = [
        {
            "remote": remote, "bench": one["bench"], "holder": (one.get("lease") or {}).get("holder"),
            "waiting": (one.get("lease") or {}).get("waiting", []), "connected": one.get("connected"),
        }
        for remote, several in found.items()
        for one in several
    ]  # fmt: skip
    here = [
        {
            "bench": one.bench, "pending": one.pending, "last": one.last, "began": one.began, "attached": one.attached,
            "here": one.here, "holder": one.holder.said if one.holder else None,
        }
        for one in local
    ]  # fmt: skip
    return {"schema": "pico.benches/v1", "local": here, "benches": benches, "meant": word_for(meant)}
