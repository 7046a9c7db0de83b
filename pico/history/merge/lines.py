"""git's own three-way merge of lines, for what is not a value."""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path

from pico.diagnostics import PicoError, error
from pico.history.merge.markers import Labels

_NAMES = ("ours", "base", "theirs")


def merge_lines(base: bytes, ours: bytes, theirs: bytes, labels: Labels) -> tuple[bytes, bool]:
    """Return three versions merged line by line, with markers, and whether that went without conflict.

    Binary content comes back as ours, in conflict. Raises PicoError where there is no git.
    """
    with tempfile.TemporaryDirectory(prefix="pico-merge-") as folder:
        for name, data in zip(_NAMES, (ours, base, theirs), strict=True):
            (Path(folder) / name).write_bytes(data)
        said = [word for name in (labels.ours, labels.base, labels.theirs) for word in ("-L", name)]
        command = ["git", "merge-file", "-p", f"--marker-size={labels.size}", *said, *_NAMES]
        try:
            done = subprocess.run(command, cwd=folder, capture_output=True, check=False)
        except FileNotFoundError:
            hint = "install git, or add it to PATH"
            raise PicoError(error("git-missing", "there is no `git` command to merge with", hint=hint)) from None
    if done.returncode > 127:
        return ours, False
    return done.stdout, done.returncode == 0
