"""What `pico runs export` wrote."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .data import size
from .diagnostics import data as listed
from .style import count

if TYPE_CHECKING:
    from pico.bench.publishing import Published


def text(made: Published) -> str:
    """Return where it is and what is in it, in two lines."""
    total = size(sum(f.size for f in made.files))
    runs = f"{count(len(made.runs), 'run')}: {', '.join(made.runs)}" if made.runs else "no run"
    first = f"Wrote {made.path}: commit {made.commit[:7]}, {count(len(made.files), 'file')}, {total}, an RO-Crate 1.1."
    return f"{first}\nEvidence {made.evidence}; {runs}."


def data(made: Published) -> dict[str, Any]:
    """Return schema `pico.publish/v1`: `path`, `commit`, `state`, `evidence`, `runs`, `files`, `diagnostics`."""
    files = [{"path": f.path, "media_type": f.media_type, "sha256": f.sha256, "size": f.size} for f in made.files]
    told = {k: getattr(made, k) for k in ("path", "commit", "state", "evidence", "runs")}
    return {"schema": "pico.publish/v1", **told, "files": files, "diagnostics": listed(made.diagnostics)["diagnostics"]}
