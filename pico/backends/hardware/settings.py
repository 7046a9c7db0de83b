"""What devices were told that they keep nowhere themselves, such as the exposure of a camera: `settings.json` in the
bench's folder."""

from __future__ import annotations

import threading

from pico.base.state_file import StateFile
from pico.base.state_files import SETTINGS
from pico.model.observation import ObservedValue
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.places.bench import BenchPlace


class Settings:
    """Values by address, as they were told last; kept in the folder of the bench. Links tell and
    ask of it, each in a thread of its own."""

    def __init__(self, place: BenchPlace, file: StateFile = SETTINGS) -> None:
        self._file, self._path = file, file.path(place.folder)
        self.emulated = place.name == "emulated"
        """Whether devices start with the `initial` values of their types; of real ones nothing is known."""
        self._lock = threading.Lock()

    def get(self, address: str, default: Value) -> Value:
        """Return what was told last, `default` if nothing was. Raises PicoError for a file that can't be read."""
        return self._read().get(address, default)

    def put(self, address: str, value: Value | None) -> None:
        """Keep what was told, None to forget it; raises PicoError where that can't be written."""
        with self._lock:
            told = {**self._read(), address: value}
            rest = {key: v for key, v in told.items() if v is not None}
            self._file.write(self._path, rest, what="the settings of the bench can't be kept")

    def commanded(self, setup: Setup) -> dict[str, ObservedValue]:
        """Return the tunables that only an arm with a tool sets, by address, as they were commanded last."""
        told, kinds = self._read(), {name: setup.type_of(name).tunables for name in setup.lab.inventory}
        known = {address: ObservedValue(value=value, status="commanded") for address, value in told.items()}
        by_arm = (f"{n}.{tunable}" for n, own in kinds.items() for tunable, kind in own.items() if kind.mover == "arm")
        return {address: known.get(address, ObservedValue(status="unknown")) for address in by_arm}

    def _read(self) -> dict[str, Value]:
        return self._file.read(self._path, dict) or {}
