"""Set-points that light finds: not a number, but where light does something, `{null_of: [p1, p2], offset: 1}`.

A number is worth what its axis is worth; after a part was re-mounted, homed or exchanged the same number is another
angle. What light says outlives that.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

from pico.model.record import record

NULL: Final = "null_of"
THROUGH: Final = "through"
OFFSET = "offset"


@dataclass(frozen=True)
class ReferenceKind:
    """One kind of reference: the elements that it `takes` two of; the `elements` and `tunables` that it stands for; an
    `example` of what it names."""

    takes: tuple[str, ...]
    elements: tuple[str, ...]
    tunables: tuple[str, ...]
    example: tuple[str, str]


KINDS: Mapping[str, ReferenceKind] = {
    NULL: ReferenceKind(("polarizer", "waveplate"), ("polarizer", "waveplate"), ("angle",), ("p1", "p2")),
    THROUGH: ReferenceKind(("iris",), ("mirror",), ("tip", "tilt"), ("iris1", "iris2")),
}


@record
class LightReference:
    """Where light says that a tunable belongs: `null_of` two parts, at which as little light passes both as can be, or
    `through` two irises; exactly one. `offset`: how much farther, in the tunable's unit."""

    null_of: tuple[str, str] | None = None
    through: tuple[str, str] | None = None
    offset: float = 0.0

    @property
    def kind(self) -> Literal["null_of", "through"]:
        """Which of the two it is."""
        return NULL if self.null_of is not None else THROUGH

    @property
    def parts(self) -> tuple[str, str]:
        """The two parts that it names."""
        found = self.null_of or self.through
        assert found is not None
        return found

    def as_json(self) -> dict[str, Any]:
        """Return it as a manifest holds it; an offset of 0 is none."""
        return {self.kind: list(self.parts)} | ({OFFSET: self.offset} if self.offset else {})


def is_reference(value: Any) -> bool:
    """Return whether a value, as a change or a document holds it, is one that light finds."""
    return isinstance(value, Mapping) and (NULL in value or THROUGH in value)


def reference_from_json(data: Mapping[str, Any]) -> LightReference:
    """Return the reference whose `as_json` gave `data`; raises KeyError, TypeError or ValueError for anything else."""
    first, second = data[NULL] if NULL in data else data[THROUGH]
    pair = (str(first), str(second))
    offset = float(data.get(OFFSET, 0.0))
    return LightReference(null_of=pair, offset=offset) if NULL in data else LightReference(through=pair, offset=offset)


def said(data: Mapping[str, Any], unit: str = "deg") -> str:
    """Return a reference, as data, in words: `1° from the null of p1 and p2`, `through iris1 and iris2`. What a person
    wrote who made a mistake is said as it is."""
    kind = NULL if NULL in data else THROUGH
    named = data[kind] if isinstance(data.get(kind), list | tuple) else [data.get(kind)]
    pair, offset = " and ".join(str(name) for name in named), data.get(OFFSET)
    if kind == THROUGH:
        return f"through {pair}"
    if not offset:
        return f"at the null of {pair}"
    away = f"{offset:.6g}{'°' if unit in ('deg', '') else f' {unit}'}" if isinstance(offset, int | float) else offset
    return f"{away} from the null of {pair}"
