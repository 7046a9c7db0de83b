"""Who has a bench on the network."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import timedelta
from typing import Any

from pico.base import clock

from .style import ago, inert, listed


def text(name: str, found: Mapping[str, Any], *, released: bool | None = None) -> str:
    """Return who has a bench, since when and what for, and who waits."""
    if released:
        return inert(f"{name} is given back.{_queue(found)}")
    holder = found["holder"]
    if not holder:
        return inert(f"Nobody has {name}.{_queue(found)}")
    who = "This checkout has" if found["mine"] else f"{holder['who']} has"
    run = f", for run {holder['run']}" if holder.get("run") else ""
    begins = "" if holder["fenced"] else "; its edge still ends what moved before"
    return inert(f"{who} {name} since {_since(holder)}{run}{begins}.{_queue(found)}")


def _queue(found: Mapping[str, Any]) -> str:
    return f" Next: {listed(list(found['waiting']))}." if found.get("waiting") else ""


def _since(holder: Mapping[str, Any]) -> str:
    """Return since when somebody has it, by the coordinator's clock alone: that of this computer may be another one."""
    now = clock.here()
    return ago((now - timedelta(seconds=holder["had"])).isoformat(), now)


def data(name: str, found: Mapping[str, Any], *, released: bool | None = None) -> dict[str, Any]:
    """Return schema `pico.lease/v1`: `bench`, its `holder` or none, who is `waiting`, whether it is `mine`, and whether
    it was `released`."""
    known = {"holder": found["holder"], "waiting": found.get("waiting", []), "mine": found["mine"]}
    return {"schema": "pico.lease/v1", "bench": name, **known, "released": released}
