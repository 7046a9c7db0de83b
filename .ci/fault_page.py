"""Print docs/reference/faults.md from the words of the drivers.

`.ci/fault_page.py` writes the page; `.ci/fault_page.py --check` says whether it is as the drivers have it.
"""

from __future__ import annotations

from pathlib import Path

from pico.drivers.xarm.faults import BOX, GRIPPER, box_fault, gripper_fault
from pico.model.instruments.fault import DeviceFault

PAGE = Path(__file__).resolve().parents[1] / "docs" / "reference" / "faults.md"
_HEAD = """# Faults of devices

What the faults of devices mean, what to check at the table, and how they are cleared. This page is printed from the
words of the drivers (`pico/drivers/xarm/faults.py`) by `make docs`; do not edit it.

`pico recover` names each fault that a device of the bench has, says what to check, and clears it once a person at a
terminal of the bench's own computer has confirmed that; `--yes` does not answer this question, and no coordinator
relays it. Then it looks, and sets down what a hand still holds. If the fault is still there, it says what to do; call
`pico recover` again after that. Faults marked "by PICO" need no person: the next command that moves clears them.
"""


def _table(title: str, about: str, faults: list[DeviceFault]) -> str:
    rows = "\n".join(
        f"| {fault.number} | {fault.means} | {fault.check} | {'a person' if fault.person else 'by PICO'} |"
        for fault in faults
    )
    return (
        f"## {title}\n\n{about}\n\n| number | it means | check at the table | cleared by |\n|---|---|---|---|\n{rows}\n"
    )


def page() -> str:
    """Return the page."""
    box = [box_fault("arm", number) for number in sorted(BOX)]
    gripper = [gripper_fault("gripper", number) for number in sorted(GRIPPER)]
    return "\n".join([
        _HEAD,
        _table("Control box of a UFACTORY xArm", "Driver `xarm.arm`; code `arm-fault`.", box),
        _table("Gripper of a UFACTORY xArm", "Driver `xarm.gripper`; code `gripper-fault`.", gripper),
    ])  # fmt: skip


if __name__ == "__main__":
    import sys

    from printing import printed

    sys.exit(printed(PAGE, page()))
