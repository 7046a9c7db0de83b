"""To which bench each file belongs that an earlier PICO kept for all of them."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from pico.disk import write_whole
from pico.places.layout import ALL, DEVICES, GONE, JOURNAL, OF_SIM, UNSORTED


@dataclass
class Sorting:
    """Where each entry of the old layout belongs."""

    folder: Path
    building: Path
    runs: Mapping[str, str | None]
    benches: tuple[str, ...] = field(init=False)
    last: str = field(init=False)

    def __post_init__(self) -> None:
        worlds = [name for name in DEVICES if (self.folder / name).is_dir()]
        known = [bench for bench in self.runs.values() if bench is not None]
        self.last = known[-1] if known else worlds[0] if len(worlds) == 1 else DEVICES[0]
        self.benches = tuple(dict.fromkeys([*known, *worlds, self.last]))

    def of_plug_ins(self) -> list[Path]:
        """Return the folders of devices of plug-ins that had runs; they stay there, too."""
        return [self.folder / name for name in self.benches if name not in DEVICES and (self.folder / name).is_dir()]

    def copy(self, path: Path) -> None:
        """Copy one entry to the bench, or the benches, that it belongs to. Raises OSError."""
        name = path.name
        if name in self.benches:
            _copied(path, self.building / name, inside=True)
        elif name in ALL:
            for bench in self.benches:
                _copied(path, self.building / bench / name)
        elif name in ("points", "recipes"):
            for one in sorted(path.iterdir()):
                _copied(one, self._of(one) / name / one.name)
        elif name == "armed":
            for one in sorted(path.glob("*.json")):
                _copied(one, self.building / self._armed(one) / name / one.name)
        elif name == "run":
            _copied(path, self._of(path) / name)
        elif name == "mornings.json":
            self._mornings(path)
        elif name in OF_SIM:
            self._into(DEVICES[0], path)
        elif name not in (JOURNAL, f"{JOURNAL}-wal", f"{JOURNAL}-shm", *GONE):
            self._into(self.last, path)

    def _into(self, bench: str, path: Path) -> None:
        _copied(path, self.building / (bench if bench in self.benches else self.last) / path.name)

    def _of(self, path: Path) -> Path:
        """Return the folder of the bench whose run a file names, by its own name or in it."""
        beside = path.with_suffix(".jsonl") if path.suffix in (".out", ".pid") else path
        text = f"{path.name}\n{beside.read_text(encoding='utf-8', errors='replace') if beside.is_file() else ''}"
        named = [bench or UNSORTED for run, bench in self.runs.items() if run in text]
        return self.building / (named[-1] if named else self.last)

    def _armed(self, path: Path) -> str:
        try:
            bench = str(json.loads(path.read_text(encoding="utf-8"))["backend"])
        except (OSError, ValueError, KeyError, TypeError):
            bench = self.last
        return bench if bench in self.benches else self.last

    def _mornings(self, path: Path) -> None:
        """Give each bench the references that its own runs are."""
        try:
            document = json.loads(path.read_text(encoding="utf-8"))
            of = [self.runs.get(one["run"]) or self.last for one in document["references"]]
        except (OSError, ValueError, KeyError, TypeError):
            self._into(self.last, path)
            return
        for bench in dict.fromkeys(of):
            own = [one for one, at in zip(document["references"], of, strict=True) if at == bench]
            data = json.dumps({**document, "references": own}, sort_keys=True).encode()
            write_whole(self.building / bench / path.name, data)


def _copied(path: Path, to: Path, *, inside: bool = False) -> None:
    to.parent.mkdir(parents=True, exist_ok=True)
    if path.is_dir():
        shutil.copytree(path, to, dirs_exist_ok=inside)
    else:
        shutil.copy2(path, to)
