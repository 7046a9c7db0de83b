"""MuJoCo's search for OpenGL, which PICO does not need, ends in a message where it ends at all."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from pico.motion.engine import no_gl

ROOT = Path(__file__).resolve().parents[2]
RENDER = ["-m", "pico_cli", "-C", str(ROOT / "labs" / "minimal"), "render", "--view", "perspective"]
EYES = """
import sys
from pathlib import Path
from pico.manifest.load import load_folder
from pico.cameras.simulated import Eyes
from pico.drawing.picture import posed_model
setup, _ = load_folder(Path(sys.argv[1])).require()
eyes = Eyes(setup, *posed_model(setup, {}, {}))
assert not eyes.frame("hand", (600, 400, 64, 64)).black
print(sorted(name for name in sys.modules if "OpenGL" in name or name.endswith("egl")))
"""


def run(*words: str, gl: str) -> subprocess.CompletedProcess[str]:
    """Run Python with `MUJOCO_GL` set."""
    environment = {**os.environ, "MUJOCO_GL": gl}
    command = [sys.executable, *words]
    return subprocess.run(command, check=False, capture_output=True, text=True, env=environment, timeout=120)


def test_a_way_to_opengl_that_is_not_there_is_a_sentence(tmp_path: Path) -> None:
    done = run(*RENDER, "--out", str(tmp_path / "bench.png"), gl="nowhere")
    assert done.returncode == 1
    assert "MUJOCO_GL is `nowhere`" in done.stderr and "unset MUJOCO_GL" in done.stderr
    assert "Traceback" not in done.stderr and not (tmp_path / "bench.png").exists()


def test_cameras_need_no_opengl() -> None:
    done = run("-c", EYES, str(ROOT / "labs" / "minimal"), gl="disable")
    assert (done.stdout, done.stderr) == ("[]\n", "")


@pytest.mark.parametrize(("asked", "package"), [("egl", "libegl1"), ("OSMesa", "libosmesa6")])
def test_the_message_names_what_to_install(asked: str, package: str) -> None:
    assert package in no_gl(asked).hint
