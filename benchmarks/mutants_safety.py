"""The modules that decide about light, motion and who may cause them, and the mutants of them that change nothing.

`mutants.py --safety` plants every mutant of these modules and runs the quick tests of the module's own package; what
survives them meets other quick tests, which is reported apart. `mutants_accepted.json` lists the mutants that cannot be
told from the original (or only by a text, a delay or the speed), each with the reason.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from mutating import Mutant

ACCEPTED = Path(__file__).with_name("mutants_accepted.json")


@dataclass(frozen=True)
class Module:
    """A module of the group: the test folders of its own package, further quick tests that execute it, and the
    functions that decide about safety (all of the module if empty; a method as `Class.method`)."""

    own: tuple[str, ...]
    others: tuple[str, ...] = ()
    functions: tuple[str, ...] = ()


_SESSION = (
    "execute", "_attempt", "_guarded", "stop", "_shut", "_halt_all", "_carried", "_require_one_step", "_require_kept",
    "_lease_over", "_require_running", "_ended", "_set",
)  # fmt: skip
SAFETY: dict[str, Module] = {
    "pico/policy/arming.py": Module(("tests/policy",), ("tests/edge",)),
    "pico/policy/audit.py": Module(("tests/policy",)),
    "pico/policy/beams.py": Module(("tests/policy",)),
    "pico/policy/dose.py": Module(("tests/policy",), ("tests/edge",)),
    "pico/policy/driven.py": Module(("tests/policy",)),
    "pico/planning/checks/emission.py": Module(("tests/planning/checks",), ("tests/edge",)),
    "pico/planning/checks/beams.py": Module(("tests/planning/checks",), ("tests/policy",)),
    "pico/model/arming.py": Module(("tests/model",), ("tests/policy",)),
    "pico/optics/audit/lasers.py": Module(("tests/optics/audit",), ("tests/planning/checks",)),
    "pico/optics/audit/limits.py": Module(("tests/optics/audit",), ("tests/planning/checks",)),
    "pico/control/leases.py": Module(("tests/control",)),
    "pico/control/gate.py": Module(("tests/control",)),
    "pico/server/guard/rates.py": Module(("tests/server/guard",)),
    "pico/teleop/deadman.py": Module(("tests/teleop",)),
    "pico/drivers/elliptec.py": Module(("tests/drivers",)),
    "pico/drivers/zaber.py": Module(("tests/drivers",)),
    "pico/drivers/limits.py": Module(("tests/drivers",)),
    "pico/drivers/line.py": Module(("tests/drivers",)),
    "pico/drivers/scpi.py": Module(("tests/drivers",)),
    "pico/drivers/switches.py": Module(("tests/drivers",)),
    "pico/edge/unattended.py": Module(("tests/edge",)),
    "pico/edge/emission.py": Module(("tests/edge",)),
    "pico/edge/armings.py": Module(("tests/edge",)),
    "pico/edge/dose.py": Module(("tests/edge",)),
    "pico/policy/capability.py": Module(("tests/policy",)),
    "pico/policy/freshness.py": Module(("tests/policy",), ("tests/history",)),
    "pico/policy/judging/judges.py": Module(("tests/policy",)),
    "pico/policy/judging/case.py": Module(("tests/policy",)),
    "pico/content/store.py": Module(("tests/content",)),
    "pico/backends/hardware/guarding.py": Module(("tests/backends/hardware",)),
    "pico/drivers/driven.py": Module(("tests/backends/hardware",)),
    "pico/backends/hardware/setting.py": Module(("tests/backends/hardware",), functions=("driven", "_device")),
    "pico/backends/hardware/session.py": Module(
        ("tests/backends/hardware",), functions=tuple(f"HardwareSession.{name}" for name in _SESSION)
    ),
}
"""The group, by module."""


@dataclass(frozen=True)
class Accepted:
    """A mutant that no test has to notice: the `line` of the module it stands in (stripped), `right` that becomes
    `wrong`, and the `reason`."""

    module: str
    line: str
    right: str
    wrong: str
    reason: str

    @property
    def key(self) -> tuple[str, str, str, str]:
        return self.module, self.line, self.right, self.wrong


def accepted() -> dict[tuple[str, str, str, str], Accepted]:
    """Return the accepted mutants by what identifies them."""
    return {one.key: one for one in (Accepted(**entry) for entry in json.loads(ACCEPTED.read_text()))}


def key_of(mutant: Mutant, text: str) -> tuple[str, str, str, str]:
    """Return what identifies a mutant of a module with this text while lines around it change."""
    return mutant.file, text.splitlines()[mutant.line - 1].strip(), mutant.right, mutant.wrong


def belongs(mutant: Mutant) -> bool:
    """Return whether a mutant is in what decides about safety of its module."""
    functions = SAFETY[mutant.file].functions
    return not functions or mutant.function in functions


def chosen(words: Iterable[str]) -> list[str]:
    """Return the modules of the group whose path contains one of the words; all of them without words. Raises
    SystemExit if a word fits none."""
    words = list(words)
    for word in words:
        if not any(word in module for module in SAFETY):
            raise SystemExit(f"no module of the safety group contains `{word}`: {', '.join(SAFETY)}")
    return [module for module in SAFETY if not words or any(word in module for word in words)]


class Judged(Protocol):
    """What became of a mutant, and in how many CPU seconds."""

    @property
    def mutant(self) -> Mutant: ...

    @property
    def outcome(self) -> str: ...

    @property
    def cpu(self) -> float: ...


def table_of(own: Sequence[Judged], elsewhere: Mapping[str, int], every: Mapping[str, int]) -> str:
    """Return a line a module: mutants, accepted ones, those killed by its own package, by others only, and by none."""
    columns = ("mutants", "accepted", "own kill", "others", "survive", "CPU s")
    lines = [f"{'module':<40}" + "".join(f"{c:>9}" for c in columns) + f"{'killed':>9}"]
    rows = []
    for file in SAFETY:
        mine = [v for v in own if v.mutant.file == file]
        left = sum(v.outcome == "survived" for v in mine)
        row = every.get(file, 0), every.get(file, 0) - len(mine), len(mine) - left, elsewhere.get(file, 0)
        rows += [(file, (*row, left - row[3], sum(v.cpu for v in mine)))] if row[0] else []
    rows.append(("all", tuple(sum(row[n] for _, row in rows) for n in range(6))))
    for name, row in rows:
        share = row[2] / ((row[0] - row[1]) or 1)
        lines.append(
            f"{name:<40}" + "".join(f"{n:>9}" for n in row[:5]) + f"{row[5]:>9.1f}{share:>9.1%}"
        )  # fmt: skip
    return "\n".join(lines)
