"""The demonstration: a robot arm rebuilds an experiment from a Git commit, twice, with gravity, contact and friction.

    python examples/demo.py [--folder demo] [--friction 1.0]

Runs the same commands that a user types, shows them, and then checks the simulated bodies against the commit with
code that knows nothing of the planner. With `--friction 0` the fingers hold nothing, and the demonstration fails.
"""

from __future__ import annotations

import argparse
import math
import os
import shlex
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pico

PICO = [sys.executable, "-c", "import sys; from pico_cli.main import main; sys.exit(main())"]
RESTORES = (("E2-3", "E2-1"), ("E3-2", "E1-1"))
LIMIT_MM, LIMIT_DEG = 0.5, 0.5


def say(text: str) -> None:
    print(text, flush=True)


def type_command(line: str, folder: Path, *, quiet: bool = False) -> int:
    """Run a command as a user would, showing it; return its exit code."""
    say(f"\n$ {line}")
    words = shlex.split(line)
    command = PICO + words[1:] if words[0] == "pico" else words
    return subprocess.run(command, cwd=folder, check=False, stdout=subprocess.DEVNULL if quiet else None).returncode


def must(line: str, folder: Path, *, quiet: bool = False) -> None:
    code = type_command(line, folder, quiet=quiet)
    if code:
        sys.exit(f"\nThe demonstration failed: `{line}` ended with {code}.")


def worst_error(folder: Path, revision: str) -> tuple[float, float]:
    """Return the greatest distance [mm] and angle [deg] between the simulated bodies and the poses of a commit."""
    from pico.model.pose import angle_between
    from pico.model.state import place_of

    bench = pico.open(folder)
    seen, wanted = bench.observe(), bench.state_at(revision)
    far, turned = 0.0, 0.0
    for name in bench.setup.lab.inventory:
        pose, (slot, goal) = seen.components[name].pose, place_of(bench.setup, wanted, name)
        if pose is None:
            sys.exit(f"{name} is gone")
        far = max(far, math.hypot(pose.x - goal.x, pose.y - goal.y))
        if slot:
            continue  # in a slot any yaw is right
        turned = max(turned, abs(angle_between(pose.yaw, goal.yaw)))
    return far, turned


def sight(folder: Path) -> str:
    """Return by what a physical run knows of the bench."""
    by_sight = pico.open(folder).setup.lab.sim.runs_by_sight("physics")
    return "sight: what cameras, joints and fingers tell is all that was known" if by_sight else "the simulator's truth"


def set_friction(folder: Path, friction: float) -> None:
    """Write the friction of the finger pads into the lab, as a user would with an editor."""
    lab = folder / "lab.yaml"
    lab.write_text(lab.read_text().replace("\nsim:\n", f"\nsim:\n  pad_friction: {friction}\n"))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=Path, default=Path("demo"))
    parser.add_argument("--friction", type=float, help="of the finger pads; 0 must fail")
    options = parser.parse_args()
    started = time.monotonic()
    folder = options.folder.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.parent.mkdir(parents=True, exist_ok=True)
    must(f"pico init --example shel {shlex.quote(os.path.relpath(folder, folder.parent))}", folder.parent)
    must("pico log --graph --oneline --all", folder)
    if options.friction is not None:
        set_friction(folder, options.friction)
    for start, goal in RESTORES:
        say(f"\n--- Bring the bench to {start} quickly (kinematic), then restore {goal} by friction and gravity ---")
        must(f"pico apply {start} --auto-approve --fidelity kinematic", folder, quiet=True)
        must(f"pico render --out {start}.png", folder)
        must(f"pico diff {start} {goal}", folder)
        must(f"pico plan {goal} --fidelity physics", folder)
        must(f"pico render {goal} --plan --view top --out {start}-to-{goal}.png", folder)
        must(f"pico apply {goal} --auto-approve --fidelity physics", folder)
        must(f"pico plan {goal} --detailed-exitcode", folder)
        must(f"pico render --out {goal}.png", folder)
        far, turned = worst_error(folder, goal)
        say(f"\nThe bodies of the simulator stand within {far:.3f} mm and {turned:.3f} deg of commit {goal}.")
        say(f"They were moved by {sight(folder)}.")
        if far > LIMIT_MM or turned > LIMIT_DEG:
            sys.exit(f"The demonstration failed: that is more than {LIMIT_MM} mm or {LIMIT_DEG} deg.")
    say(f"\nDone in {time.monotonic() - started:.0f} s. The bench and its pictures are in {options.folder}/:")
    for picture in sorted(folder.glob("*.png")):
        say(f"  {options.folder / picture.name}")


if __name__ == "__main__":
    main()
