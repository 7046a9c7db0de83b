"""What is said where a coordinator can't be reached, or does not let somebody in."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.edge.network.remotes import Far
from pico.edge.network.tokens import VARIABLE
from pico.edge.protocol import Cut

EXTRA = "pip install 'pico-lab[remote]'"


class Gone(Cut):
    """The line to a coordinator is cut; what was asked may be asked again once it is there."""


def missing_extra(exc: ImportError) -> PicoError:
    """Return what is said where the library of the network is not installed."""
    text = "a bench on the network is reached through websockets, which is not installed"
    return PicoError(error("extra", f"{text} ({exc})", hint=f"`{EXTRA}`"))


def away(url: str, why: object) -> Gone:
    """Return what is said where a coordinator does not answer."""
    text = f"the coordinator at {url} does not answer: {str(why) or 'nothing came in time'}"
    hint = (
        "is `pico serve` up there, and is that the address (`pico remote list`)? A run goes on beside the table "
        "meanwhile, and tells of itself afterwards; `pico stop` there ends it"
    )
    return Gone(error("away", text, hint=hint))


def untrusted(url: str, why: object) -> PicoError:
    """Return what is said where nobody that is known here signed the certificate of a coordinator."""
    hint = f"if it signed that itself: `pico login {url} --certificate FILE`, with the file of its certificate"
    return PicoError(error("certificate", f"{url} is not known for what it says it is: {why}", hint=hint))


def refused(status: int, body: bytes, url: str, far: Far | None = None) -> PicoError:
    """Return what an answer of HTTP says that is none of what was asked."""
    if status in (401, 403):
        return _not_let_in(status, body, url)
    if status == 404 and far is not None and not _told(body):
        text = f"{url} has no bench {far.name}"
        return PicoError(error("remote", text, hint="`pico bench list` shows those that it has"))
    if found := _told(body):
        return found
    if status in (502, 503, 504):
        return away(url, f"HTTP {status}, so what stands before it does not reach it")
    text = f"{url} answered with HTTP {status}, as no coordinator of PICO does"
    return PicoError(error("away", text, hint="`pico remote list` shows the addresses that this checkout knows"))


def _not_let_in(status: int, body: bytes, url: str) -> PicoError:
    told = _told(body)
    why = told.diagnostics[0].summary if told else ""
    if status == 401:
        text = f"{url} does not know who asks{': ' if why else ', or the token has expired'}{why}"
        right = f"`pico login {url}`, or set {VARIABLE}"
        if os.environ.get(VARIABLE):
            right = f"{VARIABLE} is set, and is taken before what `pico login` keeps: unset it, or set one that counts"
        return PicoError(error("token", text, hint=right), ExitCode.DENIED)
    hint = told.diagnostics[0].hint if told else None
    text = why or f"{url} does not let you do this"
    return PicoError(error("role", text, hint=hint or "an admin of the lab gives roles: `pico token`"), ExitCode.DENIED)


def _told(body: bytes) -> PicoError | None:
    """Return the diagnostics in an answer, None where there are none."""
    try:
        document = json.loads(body)
        return told(document)
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return None


def told(document: Mapping[str, Any]) -> PicoError | None:
    """Return what a document says that went wrong, None for one that says nothing of that."""
    from pico.edge.link import wire

    if isinstance(document.get("error"), list):
        found = wire.adapter(tuple[Diagnostic, ...]).validate_python(document["error"])
        return PicoError(found, ExitCode(document.get("exit", 1)))
    if isinstance(document.get("detail"), str):
        return PicoError(error("remote", document["detail"]))
    return None
