"""What is wrong in the entry of a device."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Complaint:
    """Something wrong in the entry of a device: at which `key` (`address.bus`), what, and what to do."""

    key: str
    text: str
    hint: str = ""
