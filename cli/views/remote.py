"""The coordinators that a checkout knows."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Any

from pico.edge.network.meant import word_for
from pico.places.bench import BenchPlace

from .style import columns, paint

if TYPE_CHECKING:
    from pico.edge.network.remotes import Place, Remotes


def text(known: Remotes, tokens: Collection[str], meant: Place) -> str:
    """Return a line a coordinator, which bench is meant, and what is to be done next."""
    if not known.named:
        return "No coordinators. `pico remote add NAME URL` adds one."
    rows = [
        [name, one.url, paint("dim", "a token is kept" if name in tokens else f"no token yet: `pico login {name}`")]
        for name, one in sorted(known.named.items())
    ]
    last = f"Commands mean {meant.said}; `pico bench list` shows the others, `pico bench use NAME` chooses one."
    return "\n".join([*columns(rows), last])


def data(known: Remotes, tokens: Collection[str], meant: Place) -> dict[str, Any]:
    """Return schema `pico.remotes/v1`: of each of the `remotes` its `url`, whether a `token` is kept and whether its
    own `certificate`; `default`, the bench of a coordinator that this worktree chose, null for one of this machine."""
    found = {
        name: {"url": one.url, "token": name in tokens, "certificate": bool(one.certificate)}
        for name, one in sorted(known.named.items())
    }
    return {
        "schema": "pico.remotes/v1",
        "remotes": found,
        "default": None if isinstance(meant, BenchPlace) else word_for(meant),
    }
