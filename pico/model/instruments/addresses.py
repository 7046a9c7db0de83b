"""Whether the parts of a device's address can be what they are said to be: IP addresses, ports, numbers on a bus."""

from __future__ import annotations

import ipaddress
import re
from collections.abc import Iterator, Mapping

from pico.model.instruments.complaint import Complaint

_PORTS = (1, 65535)
_DOTTED = re.compile(r"[0-9.]+")


def wrong_values(address: Mapping[str, str | int], numbers: Mapping[str, tuple[int, int]]) -> Iterator[Complaint]:
    """Yield what is wrong with the parts of an address; `numbers`: those that are whole numbers, with the least and
    the greatest. A port beside a host is one of TCP."""
    if (host := address.get("host")) is not None:
        yield from wrong_host(str(host), "address.host")
        numbers = {"port": _PORTS, **numbers}
    for key, (low, high) in numbers.items():
        if key in address and not _whole(address[key], low, high):
            text = f"`{key}` is a whole number from {low} to {high}, not `{str(address[key])[:40]}`"
            yield Complaint(f"address.{key}", text)


def number_in(value: str | int) -> str:
    """Return a part of an address that is a number in one way of writing; as it is if it is none."""
    text = str(value).strip()
    return str(int(text)) if text.isdecimal() else text


def _whole(value: str | int, low: int, high: int) -> bool:
    text = str(value)
    return not isinstance(value, bool) and text.isascii() and text.isdecimal() and low <= int(text) <= high


def wrong_host(host: str, key: str) -> Iterator[Complaint]:
    """Yield what is wrong with the name or the IP address of a host, at `key` of the entry."""
    if not host.strip():
        yield Complaint(key, "the host is empty", "write the name or the IP address of the device")
    elif _DOTTED.fullmatch(host):
        try:
            ipaddress.IPv4Address(host)
        except ValueError as exc:
            parts = host.split(".")
            zeros = [part for part in parts if len(part) > 1 and part[0] == "0"]
            plain = ".".join(str(int(part)) if part else part for part in parts)
            hint = f"write `{plain}`; some programs read `{zeros[0]}` as an octal number" if zeros else str(exc)
            yield Complaint(key, f"`{host[:40]}` is no IP address", hint)
