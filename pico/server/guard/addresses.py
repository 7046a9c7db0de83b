"""Which names the coordinator answers to, and which pages may speak to it.

A page of a stranger can let its own name lead here (DNS rebinding), and can open sockets to any name: so the Host of
each request must be a name of this coordinator, and an Origin, which browsers send along, that very host.
"""

from __future__ import annotations

import ipaddress
from urllib.parse import urlsplit

from pico.diagnostics import PicoError, error

LOOPBACK = frozenset({"localhost", "127.0.0.1", "::1"})
_PORTS = {"http": 80, "ws": 80, "https": 443, "wss": 443}


def host_of(header: str, scheme: str) -> tuple[str, int] | None:
    """Return name and port of a Host header; None for what is none."""
    try:
        parts = urlsplit(f"//{header}")
        bare = (
            not (parts.path or parts.query or parts.fragment or parts.username is not None) and header.strip() == header
        )
        name = parts.hostname
        return (name.rstrip("."), parts.port or _PORTS[scheme]) if name and bare else None
    except (ValueError, KeyError):
        return None


def same_origin(origin: str, host: str) -> bool:
    """Whether an Origin is the host that was asked. Its scheme counts for the port alone: a proxy may end TLS."""
    scheme, mark, rest = origin.partition("://")
    return (
        bool(mark)
        and scheme in ("http", "https")
        and host_of(rest, scheme) is not None
        and host_of(rest, scheme) == host_of(host, scheme)
    )


def is_loopback(host: str) -> bool:
    """Whether an address to listen at is reached from this machine alone."""
    try:
        return host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def require_safe(host: str, *, tls: bool) -> None:
    """Raise PicoError for an address that others reach where nothing keeps what is said from them."""
    if tls or is_loopback(host):
        return
    hint = "`--certificate FILE --key FILE`; or stay at 127.0.0.1 behind a proxy on this machine that does TLS"
    raise PicoError(
        error("insecure", f"{host} is reached by others, and tokens would go there in the clear", hint=hint)
    )
