"""The shel lab with its instruments, in a folder of its own."""

from __future__ import annotations

import shutil
from pathlib import Path

from pico.manifest.load import load_folder
from pico.model.setup import Setup

ROOT = Path(__file__).resolve().parents[3]
LAB = ROOT / "labs" / "shel"


def wired_lab(folder: Path) -> Setup:
    """Make the lab in `folder`, and return it with its instruments."""
    for name in ("lab.yaml", "state"):
        (shutil.copytree if (LAB / name).is_dir() else shutil.copy)(LAB / name, folder / name)
    shutil.copy(ROOT / "examples" / "devices.yaml", folder)
    setup, _ = load_folder(folder).require()
    return setup
