"""Formats of documents that outlive the program which wrote them: each names its version, and old ones are lifted."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Mapping
from typing import Any

from pico.version import upgrade_hint

Document = Mapping[str, Any]
Step = Callable[[Document], Document]
"""Takes a document of one version and returns the same document in the next."""


@dataclasses.dataclass(frozen=True)
class Format:
    """A format by name (`pico.plan`). `steps[i]` lifts a document from version i + 1 to the next; without any, the
    format is as it was at first."""

    name: str
    steps: tuple[Step, ...] = ()

    @property
    def schema(self) -> str:
        """What is written into a document: name and current version."""
        return f"{self.name}/v{len(self.steps) + 1}"

    def lifted(self, document: object) -> dict[str, Any]:
        """Return a document of any version up to the current one as the current one has it.

        Raises ValueError, whose words follow after "it is", where it is of another format or of a newer PICO.
        """
        said = document.get("schema") if isinstance(document, Mapping) else None
        found = re.fullmatch(rf"{re.escape(self.name)}/v([1-9][0-9]{{0,5}})", said) if isinstance(said, str) else None
        if not found:
            raise ValueError(f"no {self.schema}, but {str(said)[:40]!r}")
        if (version := int(found[1])) > len(self.steps) + 1:
            raise ValueError(f"of a newer PICO ({said}; this one reads up to {self.schema}): {upgrade_hint()}")
        assert isinstance(document, Mapping)
        for step in self.steps[version - 1 :]:
            document = step(document)
        return {**document, "schema": self.schema}
