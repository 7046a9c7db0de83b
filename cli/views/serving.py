"""Where a coordinator serves, and how one gets in."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..runs.demonstration import Demonstrated


def text(url: str, folder: Path, code: str | None, shown: Demonstrated | None = None) -> str:
    """Return where it serves, and what to type: to log in as the first admin, or to reach a bench that is `shown`."""
    lines = [f"The coordinator serves at {url}; its books are in {folder}."]
    if code:
        lines.append(f"Nobody is known here yet. As admin: `pico login {url} --code {code}`, within 2 days.")
    if shown is not None:
        lines += [
            f"{shown.bench} is in the twin, its edge a process of its own. In another terminal:",
            f"  pico init --example {shown.lab} my-{shown.lab} && cd my-{shown.lab}",
            f"  pico login {url} --code {shown.code}",
            f"  pico remote add demo {url} --default {shown.bench}",
            "  pico status",
        ]
    return "\n".join([*lines, "Ctrl-C ends it."])


def data(url: str, folder: Path, code: str | None, shown: Demonstrated | None = None) -> dict[str, Any]:
    """Return schema `pico.serving/v1`: `url`, `folder`, `code` to log in with, null where nobody new is to, and
    `bench`, which is demonstrated, else null."""
    bench, code = (shown.bench, shown.code) if shown is not None else (None, code)
    return {"schema": "pico.serving/v1", "url": url, "folder": str(folder), "code": code, "bench": bench}
