"""What goes over the sockets between client, coordinator and edge: one JSON object a message.

A call is `{"id", "call", "with"}`, its answers carry its id and are those of `pico.edge.link.wire`; `{"id", "close"}`
lets go of what a call took or follows. What only edge and coordinator say to each other is told of in `uplink`.
"""

from __future__ import annotations

import hashlib
import hmac
import json
from collections.abc import Mapping
from typing import Any

from pico.diagnostics import PicoError, error
from pico.edge.link import wire

LONGEST = 1 << 26
"""Bytes of the longest message."""
POLL = 1.0
"""Seconds between two questions of an edge for how long its lease holds."""
PING, SILENT = 2.0, 6.0
"""Seconds between two pings of a socket, and after which one that is not answered ends it."""
UNDER_LEASE = (wire.TAKES | {"execute", "finish"}) - {"arm", "disarm", "hold"}
"""Calls that are done under a lease, each once; what arms, disarms and tidies up is done whoever has the bench."""
SCHEME = "PicoEdge"
"""Of the authorization by which an edge dials: its bench, a nonce, and a proof over that."""


def text(document: Mapping[str, Any]) -> str:
    """Return a message as it goes over a socket."""
    return json.dumps(document, separators=(",", ":"))


def read(data: str | bytes) -> dict[str, Any]:
    """Return a message; raises PicoError for what is none."""
    try:
        document = json.loads(data)
    except (ValueError, RecursionError) as exc:
        raise PicoError(error("link", f"this is no message: {str(exc)[:200]}")) from exc
    if not isinstance(document, dict):
        raise PicoError(error("link", "this is no message: it is to be a JSON object"))
    return document


def read_call(document: Mapping[str, Any]) -> tuple[str, list[Any]]:
    """Return the name of a call and its arguments as JSON data; raises PicoError for what is none."""
    name, given = document.get("call"), document.get("with")
    if not isinstance(name, str) or not isinstance(given, list):
        raise PicoError(error("link", "this is no call: it has a `call` and a list `with`"))
    return name, given


def is_last(answer: Mapping[str, Any]) -> bool:
    """Return whether no other answer to the same call follows."""
    return "next" not in answer


def content(call: str, arguments: Any) -> str:
    """Return the digest of a call."""
    whole = json.dumps([call, arguments], sort_keys=True, separators=(",", ":"))
    return "sha256:" + hashlib.sha256(whole.encode()).hexdigest()


def proof(key: bytes, who: str, bench: str, mine: str, theirs: str) -> str:
    """Return what shows that `who` has the key of a bench's edge, by the nonces of both."""
    said = "\n".join((who, bench, mine, theirs)).encode()
    return hmac.new(key, said, hashlib.sha256).hexdigest()
