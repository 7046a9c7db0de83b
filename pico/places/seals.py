"""The seals of the Labs that benches keep: `pico/labs.json` of Git's own folder holds the SHA-256 of each, by the
lab's folder in the repository and the bench. A checkout overwrites what lies in `.pico` if somebody committed that."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from pico.disk import write_whole
from pico.places.lab import LabPlace
from pico.places.record import SHARED

FILE = "labs.json"
Seals = Mapping[str, Mapping[str, list[str]]]


def sealed_labs(lab: LabPlace) -> dict[str, dict[str, list[str]]]:
    """Return the digests by lab and bench, those of an earlier PICO for all benches of the lab (`SHARED`); none if the
    file can't be read."""
    try:
        found = json.loads(_path(lab).read_bytes())
        return {str(inside): _lifted(digests) for inside, digests in found.items()}
    except (OSError, ValueError, AttributeError, TypeError):
        return {}


def write_seals(lab: LabPlace, seals: Seals) -> None:
    """Let Git's folder know these digests; raises PicoError."""
    write_whole(_path(lab), (json.dumps(seals, indent=1, sort_keys=True) + "\n").encode(), folders=True)


def _path(lab: LabPlace) -> Path:
    return lab.common / "pico" / FILE


def _lifted(digests: object) -> dict[str, list[str]]:
    if isinstance(digests, dict):
        return {str(name): [str(one) for one in those] for name, those in digests.items()}
    return {SHARED: [str(one) for one in digests]} if isinstance(digests, list) else {}
