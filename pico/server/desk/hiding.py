"""What commands at desks say, without where the coordinator keeps its books: a path of a desk begins at the desk."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

from pico.diagnostics import PicoError


class Hiding:
    """Takes the folder of a coordinator's books, and of each desk in it, out of text."""

    def __init__(self, folder: Path) -> None:
        known = {str(folder), str(folder.resolve())}
        forms = known | {json.dumps(one, ensure_ascii=ascii)[1:-1] for one in known for ascii in (True, False)}
        names = b"|".join(re.escape(one.encode()) for one in sorted(forms, key=len, reverse=True))
        desk = rb"/desks/[^/\s\"'\\]+/(?:at|of|on)/[^/\s\"'\\]+"
        self._path = re.compile(rb"(?:" + names + rb")(?![\w.-])(?:" + desk + rb")?(/(?=[\w.-]))?")

    def of(self, said: bytes) -> bytes:
        """Return a line, UTF-8 or JSON, with paths that begin at a desk or in the books."""
        return self._path.sub(lambda found: b"" if found[1] else b".", said)

    def error(self, exc: PicoError) -> PicoError:
        """Return an error that names no such folder."""
        found = [
            replace(one, summary=self._text(one.summary), detail=self._text(one.detail), hint=self._text(one.hint))
            for one in exc.diagnostics
        ]
        return PicoError(found, exc.exit_code)

    def _text(self, text: str) -> str:
        return self.of(text.encode()).decode()
