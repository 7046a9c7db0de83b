"""A lab that is changed as people change one."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Lab:
    root: Path

    @property
    def state(self) -> Path:
        return self.root / "state" / "table.yaml"

    def edit(self, before: str, after: str, file: str = "state/table.yaml") -> None:
        path = self.root / file
        text = path.read_text()
        assert before in text
        path.write_text(text.replace(before, after, 1))

    def expect(self, *expressions: str) -> None:
        lines = "".join(f"  - that: '{e}'\n" for e in expressions)
        self.state.write_text(f"{self.state.read_text()}expect:\n{lines}")

    def git(self, *arguments: str) -> str:
        done = subprocess.run(["git", *arguments], cwd=self.root, check=True, capture_output=True, text=True)
        return done.stdout.strip()

    def commit(self, message: str = "change") -> str:
        self.git("add", "-A")
        self.git("commit", "-q", "-m", message)
        return self.git("rev-parse", "HEAD")
