"""The seals of the Labs that benches keep: `pico/labs.json` of Git's own folder holds the SHA-256 of each, by the
lab's folder in the repository and the bench. A checkout overwrites what lies in `.pico` if somebody committed that."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from pico.base.state_files import SEALS
from pico.places.lab import LabPlace
from pico.places.record import SHARED

Seals = Mapping[str, Mapping[str, list[str]]]


def sealed_labs(lab: LabPlace) -> dict[str, dict[str, list[str]]]:
    """Return the digests by lab and bench, those of an earlier PICO for all benches of the lab (`SHARED`); Raises
    PicoError for a file that can't be read."""
    return SEALS.read(_path(lab), _seals) or {}


def _seals(document: Mapping[str, object]) -> dict[str, dict[str, list[str]]]:
    return {inside: _lifted(digests) for inside, digests in document.items()}


def write_seals(lab: LabPlace, seals: Seals) -> None:
    """Let Git's folder know these digests; raises PicoError."""
    SEALS.write(_path(lab), seals, indent=1)


def _path(lab: LabPlace) -> Path:
    return SEALS.path(lab.common / "pico")


def _lifted(digests: object) -> dict[str, list[str]]:
    if isinstance(digests, dict):
        return {str(name): [str(one) for one in those] for name, those in digests.items()}
    return {SHARED: [str(one) for one in digests]} if isinstance(digests, list) else {}
