"""How what went wrong is said over HTTP: the diagnostics as the link has them, and a status."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from pico.diagnostics import ExitCode, PicoError, error
from pico.model.record import as_json

STATUS: Mapping[str, int] = {
    "unauthenticated": 401,
    "forbidden": 403,
    "unknown-bench": 404,
    "unknown-principal": 404,
    "unknown-token": 404,
    "unknown-lab": 404,
    "unknown-data": 404,
    "unknown-run": 404,
    "limit": 429,
    "too-long": 413,
    "away": 503,
    "books": 503,
    "internal": 500,
}
"""The status of what is wrong, by its code; 409 for a bench that somebody else has and what is stale, else 400."""
_CODES = {403: "forbidden", 404: "unknown", 413: "too-long", 421: "wrong-host", 429: "limit"}


def status_of(exc: PicoError) -> int:
    """Return the status with which an error is answered."""
    if exc.exit_code in (ExitCode.LOCKED, ExitCode.STALE):
        return 409
    if exc.exit_code == ExitCode.DENIED:
        return 403
    return STATUS.get(exc.diagnostics[0].code, 400) if exc.diagnostics else 400


def failure(exc: PicoError) -> dict[str, Any]:
    """Return what went wrong, as JSON; the same as over the link to an edge."""
    return {"error": as_json(exc.diagnostics), "exit": int(exc.exit_code)}


def document(status: int, text: str) -> bytes:
    """Return the body of an answer that says what is wrong."""
    return json.dumps(failure(PicoError(error(_CODES.get(status, "usage"), text)))).encode()
