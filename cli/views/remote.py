"""The coordinators that a checkout knows."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Any

from .style import columns, paint

if TYPE_CHECKING:
    from pico.edge.network.remotes import Remotes


def text(known: Remotes, tokens: Collection[str]) -> str:
    """Return a line a coordinator, which bench is meant, and what is to be done next."""
    if not known.named:
        return "No coordinators. `pico remote add NAME URL` adds one."
    rows = [
        [name, one.url, paint("dim", "a token is kept" if name in tokens else f"no token yet: `pico login {name}`")]
        for name, one in sorted(known.named.items())
    ]
    meant = f"Commands mean {known.default}; `--bench local` means the bench of this checkout."
    other = "Commands mean the bench of this checkout: `pico bench list`, then `pico bench use LAB/BENCH`."
    return "\n".join([*columns(rows), meant if known.default else other])


def data(known: Remotes, tokens: Collection[str]) -> dict[str, Any]:
    """Return schema `pico.remotes/v1`: of each of the `remotes` its `url`, whether a `token` is kept and whether its
    own `certificate`; `default`."""
    found = {
        name: {"url": one.url, "token": name in tokens, "certificate": bool(one.certificate)}
        for name, one in sorted(known.named.items())
    }
    return {"schema": "pico.remotes/v1", "remotes": found, "default": known.default or None}
