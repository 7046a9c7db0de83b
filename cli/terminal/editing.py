"""Git's editor on a message: `core.editor`, `GIT_EDITOR`, `VISUAL` and `EDITOR` count as they do for git."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError, error
from pico.disk import write_whole
from pico.history.git import command as git

if TYPE_CHECKING:
    from pico.bench.bench import Bench

_HINT = "# Say why. Lines that begin with `#` are left out; an empty message gives up.\n"


def edited(bench: Bench, text: str) -> str:
    """Return a message as somebody left it in the editor; raises PicoError where that fails, or leaves nothing."""
    repository = bench.folder.history()
    editor = git.run(repository.root, ["var", "GIT_EDITOR"], doing="name an editor").strip()
    path = repository.own / "pico" / "COMMIT_EDITMSG"
    write_whole(path, f"{text.rstrip()}\n\n{_HINT}".encode(), folders=True, durable=False)
    said = _open(editor, path)
    if not said.strip():
        raise PicoError(error("message", "the message is empty: nothing was committed"))
    return said


def _open(editor: str, path: Path) -> str:
    """Run an editor as git does, through the shell, for it may be `code --wait`."""
    try:
        done = subprocess.run(["sh", "-c", f'{editor} "$@"', editor, str(path)], check=False)
        if done.returncode:
            text = f"the editor `{editor}` ended with {done.returncode}: nothing was committed"
            raise PicoError(error("editor", text, hint="set another one: `git config core.editor NAME`"))
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    finally:
        path.unlink(missing_ok=True)
    return "\n".join(line.rstrip() for line in lines if not line.startswith("#")).strip()
