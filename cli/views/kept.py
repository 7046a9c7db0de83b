"""What a run kept as pictures, and how they are drawn."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from .runs import shown
from .style import columns, count, paint

if TYPE_CHECKING:
    from pico.bench.picturing.kept import Kept


def text(found: Sequence[Kept], absent: Collection[str]) -> str:
    """Return a table of what was kept; `absent`: the SHA-256 of what is not here."""
    head = [paint("dim", cell) for cell in ("operation", "of", "", "")]
    rows = [
        [*_row(one), paint("red", "not here: `pico data pull`") if one.array.sha256 in absent else ""] for one in found
    ]
    hint = "`--out DIR` draws them, `--json` tells them as data."
    return "\n".join([*columns([head, *rows]), "", f"{count(len(found), 'picture')}: {hint}"])


def _row(one: Kept) -> list[str]:
    op = one.operation
    name = f"{op.run[-6:]} {op.id}".strip() + (f" (attempt {op.attempt})" if op.attempt > 1 else "")
    size = " x ".join(map(str, one.array.shape))
    tried = f"{count(one.array.shape[0], 'measurement')} of a search"
    return [shown(name), shown(one.title), f"{size} {shown(one.array.dtype)}" if one.measurement else tried]
