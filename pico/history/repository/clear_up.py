"""What the guard runs after a PICO that was killed: `python -P -m pico.history.repository.clear_up FOLDER`."""

from __future__ import annotations

import sys
from contextlib import suppress
from pathlib import Path

from pico.diagnostics import PicoError
from pico.history.repository.repository import Repository


def main() -> None:
    """Clear up in the working tree that the command line names."""
    with suppress(PicoError):
        repository = Repository.discover(Path(sys.argv[1]))
        if repository is not None:
            repository.leave_word()


if __name__ == "__main__":
    main()
