"""git's own three-way merge of lines, for what is not a value."""

from __future__ import annotations

import subprocess

from pico.diagnostics import PicoError, error
from pico.disk import unnamed
from pico.history.merge.markers import Labels


def merge_lines(base: bytes, ours: bytes, theirs: bytes, labels: Labels) -> tuple[bytes, bool]:
    """Return three versions merged line by line, with markers, and whether that went without conflict.

    Binary content comes back as ours, in conflict. Raises PicoError where there is no git.
    """
    with unnamed(ours) as a, unnamed(base) as b, unnamed(theirs) as c:
        files = [file.fileno() for file in (a, b, c)]
        said = [word for name in (labels.ours, labels.base, labels.theirs) for word in ("-L", name)]
        command = ["git", "merge-file", "-p", f"--marker-size={labels.size}", *said, *(f"/dev/fd/{n}" for n in files)]
        try:
            done = subprocess.run(command, capture_output=True, check=False, pass_fds=files)
        except FileNotFoundError:
            hint = "install git, or add it to PATH"
            raise PicoError(error("git-missing", "there is no `git` command to merge with", hint=hint)) from None
    if done.returncode > 127:
        return ours, False
    return done.stdout, done.returncode == 0
