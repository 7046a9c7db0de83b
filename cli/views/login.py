"""Whom a coordinator knows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.base import clock

from .style import inert, listed


def text(url: str, me: Mapping[str, Any]) -> str:
    """Return who one is there, what one may, and until when."""
    until = _until(me)
    end = f", until {until[:10]}" if until else ""
    may = listed([str(one) for one in me.get("rights", ())]) or "nothing yet"
    return inert(f"You are {me.get('name')} at {url}{end}: {may}. `pico bench list` shows its benches.")


def data(url: str, me: Mapping[str, Any]) -> dict[str, Any]:
    """Return schema `pico.login/v1`: `url`, `name`, `rights`, `expires_at`."""
    known = {"name": me.get("name"), "rights": me.get("rights"), "expires_at": _until(me)}
    return {"schema": "pico.login/v1", "url": url, **known}


def _until(me: Mapping[str, Any]) -> str | None:
    """Return when a token is over, as ISO 8601; it comes as that, or as seconds since 1970."""
    at = me.get("expires_at")
    return clock.as_text(clock.from_epoch(at)) if isinstance(at, int | float) else at
