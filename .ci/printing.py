"""What the scripts that print pages of docs/ have in common: write a page, or check it (`--check`)."""

from __future__ import annotations

import sys
from pathlib import Path


def printed(path: Path, text: str) -> int:
    """Write a page; with `--check` among the arguments only say whether it is current. Return the exit code."""
    if "--check" not in sys.argv:
        path.write_text(text, encoding="utf-8")
        return 0
    if path.exists() and path.read_text(encoding="utf-8") == text:
        return 0
    print(f"{path.name} is not current: run `make docs`", file=sys.stderr)
    return 1
