"""A benchmark that nobody runs rots: each runs here at its smallest size. What they measure is not judged."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
BENCHMARKS = ROOT / "benchmarks"
SWAP = {"n": 2, "density": 0.3, "radius": 70.0, "start": [[300, 300], [700, 300]], "goal": [[700, 300], [300, 300]],
        "min_staging": 1}  # fmt: skip

SMALLEST = {
    "bisecting": "--commits 8 --seeds 1 --pairs 1",
    "blame": "--commits 12 --components 10 --files 2 --merges --runs",
    "by_sight": "--moves 1 --seeds 1",
    "calibration": "--only odd --scenes 1",
    "calibration_procedure": "--seeds 1 --shots 8 --pixels 1224",
    "carrying": "--components 30 --commits 5 --repeat 1",
    "cleared_faults": "--cases 3",
    "commits": "--processes 2 --each 1 --kills 2 --capture 30",
    "control_plane": "--crashes 2000 --seeds 300 --only number",
    "cross_bench": "--only 3 4 --seed 11 --jobs 2",
    "crash_points": "--crashes 300",
    "damaged_state": "--tries 4 --short-day --seed 3",
    "data": "--commits 20 --objects 3 --size 0.1 --kills 2",
    "disks": "fmt note blame --points 1",
    "eyes": "--scenes 1 --renderer raycast",
    "identical": "",
    "idle_connections": "--connections 200 --limit 256",
    "interferometers": "--frames 1 --points 3 --size 128 96 --repeat 1",
    "kernels": "--seeds 1 --shape 1000 1200",
    "kills": "--kills 50 --applies 1 --git 9",
    "absorbed": "--seeds 1 --seat 1",
    "beam_audit": "--repeat 1",
    "beam_pictures": "--pictures 20 --plant saturation-ignored",
    "alignment": "--seeds 1",
    "faulted_loops": "--loops 12 --kills 2 --goals tip null",
    "stages": "--seeds 1",
    "random_recipes": "--recipes 2 --broken 4",
    "recipe_kills": "--kills 1 --until 7",
    "real_bench": "",
    "recording": "--settings 3 --kills 2",
    "shel": "--seeds 1 --fidelity kinematic --only 30",
    "restoration": "--experiments 1 --fidelity kinematic --history staged --only C3 --dark",
    "refusals": "--labs 6",
    "restoring_light": "--seeds 1 --fidelity kinematic --passive --exact",
    "morning": "--nights 1 --faults 0",
    "lease_histories": "--histories 1 --deeds 10",
    "lens_by_light": "--seeds 1 --fidelity kinematic",
    "light": "--repeat 1",
    "links": "--kills 1",
    "locks": "--trials 1",
    "makespan": "--labs shel",
    "merges": "--cases 20 --git 2 --failing 2 --impossible 2 --moves 10 --moves-by-git 2",
    "motion": "--moves 4 --parts 6",
    "mutants": "--seed 1 --count 4 --rooms policy --tests tests/policy",
    "network": "--trips 20 --steals 2 --edges 3 --watchers 2 --seconds 1",
    "network_restoration": "--fidelity kinematic --path C3 E1-1",
    "network_teleop": "--frozen 1 --cut 2",
    "nights": "--nights 1 --quiet 0 --lab shel",
    "network_kills": "--faults 1 --sim --longest 1",
    "null_of": "--seeds 1",
    "omissions": "--cases 30",
    "optics_references": "",
    "page": "--opens 1 --picks 2 --pages 1 --seconds 1",
    "pick_and_place": "--moves 1 --sight exact",
    "placements": "--moves 1 --sight exact",
    "planning_fuzz": "--cases 5 --most 8",
    "planted_bugs": "--seeds 500 --only start",
    "predicted": "--transitions 1 --labs labs/minimal",
    "runs": "--faults 2 --interrupts 2 --pairs 1 --journal 20 --scheduler 1",
    "safety_chain": "--faults door --states idle --only-dead-man",
    "safety_network": "--links silent --states idle",
    "scale": "--components 40 --moves 6 --check",
    "scan": "--looks 1 --lab labs/minimal",
    "set_points": "--threads 1 --seconds 1 --inline",
    "sensor": "--repeat 1 --size 128 96",
    "size": "",
    "staging": "INSTANCES --tables 1",
    "strangers": "--things 1 --swaps 1",
    "startup": "--sizes 10 --repeat 1",
    "taken_up": "--moves 3",
    "teleop": "--stops 1 --arm 0 --sessions 2",
    "wire_replies": "--replies 12 --only scpi.meter scpi.safety switches.laser elliptec.slider frames.camera "
    "scpi.choice realsense.camera xarm.gripper-fault",
    "through": "--seeds 1",
    "travel": "--sizes 8 --densities 0.2 --cases 1 --moves 2000",
    "twin_speed": "--moves 1",
    "wire_faults": "--operations 2",
    "xarm_link": "--seconds 1 --losses 1",
    "xarm_transcript": "",
    "undo": "--cycles 2 --held 1",
    "wrong_benches": "--only meter",
}
ELSEWHERE = {"identical": "tests/planning/test_identical.py"}
"""Those that have a slow test of their own."""
MISSED = 3
"""How one ends by a figure alone, which so small a size or another machine's load decides."""


def test_every_benchmark_has_a_smallest_size() -> None:
    commands = {p.stem for p in BENCHMARKS.glob("*.py") if '__name__ == "__main__"' in p.read_text()}
    assert commands == SMALLEST.keys()
    assert all((ROOT / path).exists() for path in ELSEWHERE.values())


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(SMALLEST.keys() - ELSEWHERE.keys()))
def test_a_benchmark_runs(name: str, tmp_path: Path) -> None:
    (tmp_path / "instances.json").write_text(json.dumps({"instances": [SWAP]}))
    words = SMALLEST[name].replace("INSTANCES", str(tmp_path / "instances.json")).split()
    done = subprocess.run(
        [sys.executable, f"benchmarks/{name}.py", *words],
        cwd=ROOT, env=os.environ | {"TMPDIR": str(tmp_path)}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode in (0, MISSED), done.stdout + done.stderr
    assert done.stdout.strip()
