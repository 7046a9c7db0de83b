"""PICO: version control for the optical table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.version import __version__

if TYPE_CHECKING:
    from pathlib import Path

    from pico.diagnostics import Diagnostic, ExitCode, PicoError
    from pico.model.diff import Change
    from pico.model.measurement import Measurement
    from pico.model.observation import Observation
    from pico.model.plan import Plan
    from pico.model.pose import Pose
    from pico.model.state import LabState
    from pico.model.trace.report import Captured, Committed, RunReport
    from pico.model.trace.run import Run, TraceEvent
    from pico.runs.document import RecordedRun
    from pico.scripting.bench import Bench
    from pico.scripting.parts import Part
    from pico.scripting.readings import Measurable, Reading
    from pico.scripting.recording import Recording
    from pico.scripting.status import Status
    from pico.scripting.tunables import Tunable

_OF = {
    "pico.diagnostics": ("Diagnostic", "ExitCode", "PicoError"),
    "pico.model.diff": ("Change",),
    "pico.model.measurement": ("Measurement",),
    "pico.model.observation": ("Observation",),
    "pico.model.plan": ("Plan",),
    "pico.model.pose": ("Pose",),
    "pico.model.trace.report": ("Captured", "Committed", "RunReport"),
    "pico.model.trace.run": ("Run", "TraceEvent"),
    "pico.model.state": ("LabState",),
    "pico.runs.document": ("RecordedRun",),
    "pico.scripting.bench": ("Bench",),
    "pico.scripting.parts": ("Part",),
    "pico.scripting.readings": ("Measurable", "Reading"),
    "pico.scripting.recording": ("Recording",),
    "pico.scripting.status": ("Status",),
    "pico.scripting.tunables": ("Tunable",),
}
"""Where the names are that `pico` has, which are imported when somebody asks for them."""
_WHERE = {name: module for module, names in _OF.items() for name in names}

__all__ = [
    "Bench",
    "Captured",
    "Change",
    "Committed",
    "Diagnostic",
    "ExitCode",
    "LabState",
    "Measurable",
    "Measurement",
    "Observation",
    "Part",
    "PicoError",
    "Plan",
    "Pose",
    "Reading",
    "RecordedRun",
    "Recording",
    "Run",
    "RunReport",
    "Status",
    "TraceEvent",
    "Tunable",
    "__version__",
    "open",
]  # fmt: skip


def open(path: str | Path = ".", **options: Any) -> Bench:
    """Open the laboratory in folder `path` (or any folder below it) and return its bench.

    `pico://host/lab/bench` as `path`: that bench on the network, for the laboratory around the working directory.
    Options are those of `pico.bench.bench.Bench.open` (`backend`, `fidelity`, `speed`, `bench`).
    Raises `PicoError` where the folder holds no laboratory or its manifests are wrong.

    >>> bench = pico.open("labs/shel", fidelity="kinematic")
    """
    from pico.scripting.bench import Bench

    if isinstance(path, str) and path.startswith("pico://"):
        return Bench.open(**{"bench": path, **options})
    return Bench.open(path, **options)


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module 'pico' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_WHERE[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
