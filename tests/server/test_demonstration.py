"""`pico serve --demo shel`: one command, and a client in another folder moves the bench."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

PICO = [sys.executable, "-m", "pico_cli"]


@pytest.mark.slow
def test_a_client_reaches_the_demonstration_as_it_is_told_to(tmp_path: Path) -> None:
    environment = os.environ | {"XDG_CONFIG_HOME": str(tmp_path / "config")}
    words = [*PICO, "serve", "--demo", "minimal", "--folder", str(tmp_path / "demo"), "--port", "0", "--json"]

    def pico(*asked: str, at: Path = tmp_path) -> str:
        done = subprocess.run([*PICO, *asked], cwd=at, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    with subprocess.Popen(words, cwd=tmp_path, stdout=subprocess.PIPE, text=True, env=environment) as serving:
        assert serving.stdout is not None
        try:
            told = json.loads(serving.stdout.readline())
            assert told["bench"] == "minimal/bench1"
            asked = ["pgrep", "-P", str(serving.pid)]
            below = subprocess.run(asked, capture_output=True, text=True, check=True).stdout.split()
            assert len(below) == 2, "the edge, and what runs commands at desks"
            pico("init", "--example", "minimal", "mine")
            mine = tmp_path / "mine"
            pico("login", told["url"], "--code", told["code"])
            pico("remote", "add", "demo", told["url"], "--default", told["bench"], at=mine)
            yaw = [json.loads(pico("get", "lens.pose", "--json", at=mine))["values"]["pose"]["value"]]
            pico("move", "lens", "turn=10", "--yes", at=mine)
            yaw.append(json.loads(pico("get", "lens.pose", "--json", at=mine))["values"]["pose"]["value"])
            assert yaw[0] != yaw[1]
        finally:
            serving.send_signal(signal.SIGINT)
            assert serving.wait() == 0
    assert not [process for process in below if Path(f"/proc/{process}").exists()]
