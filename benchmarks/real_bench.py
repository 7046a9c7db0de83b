"""The case study from E3-2 to E1-1 and back on a bench that PICO takes for a real one, one command each way.

    python benchmarks/real_bench.py --pace 10

The emulators are a process of their own, whose addresses stand in `devices.yaml`; `pico --backend hardware` finds them
as it would find devices. A person (a terminal that answers y) commissions it as far as calibration is not concerned:
devices, identities, the motion test. The laser is attenuated to class 2, since a higher one needs a calibrated bench.
`--pace`: how many times as fast as real ones emulated motions are. Exit code 1: a command did not end with 0; 3: for an
emulator did not answer in time.
"""

from __future__ import annotations

import argparse
import json
import os
import pty
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parent.parent
PICO = [sys.executable, "-m", "pico_cli"]
REAL = ("--backend", "hardware")
LATE, MISSED = ("device-lost", "has not answered"), 3
"""What a command says of devices that did not answer in time, which emulators on a loaded machine don't."""
OPEN = 2
"""How a commissioning ends of which steps are left, such as calibration."""


def serve(lab: Path) -> None:
    """Be the emulators of a lab until standard input ends, with their addresses in its `devices.yaml`."""
    from pico.backends.emulated.bench import brought_up
    from pico.backends.instruments import emulated
    from pico.manifest.load import load_folder
    from pico.places.bench import BenchPlace

    setup, _ = load_folder(lab).require()
    assert setup.wiring is not None
    _, bench = brought_up(setup, BenchPlace(lab, "emulated"), emulated(dict(setup.wiring.devices)))
    path = lab / "devices.yaml"
    document = yaml.safe_load(path.read_text())
    for name, said in document["devices"].items():
        entry = bench.entries[name]
        said["address"], said["identity"] = dict(entry.address), dict(entry.identity)
        said["settings"] = dict(entry.settings)
    path.write_text(yaml.safe_dump(document, sort_keys=False))
    print("ready", flush=True)
    sys.stdin.read()


def make_lab(folder: Path, environment: dict[str, str]) -> None:
    """Make the case study with its devices, a laser of class 2, and cameras of fewer pixels."""
    subprocess.run([*PICO, "init", "--example", "shel", str(folder)], env=environment, check=True, capture_output=True)
    shutil.copy(ROOT / "examples" / "devices.yaml", folder)
    lab = folder / "lab.yaml"
    text = lab.read_text().replace("pixels: [2448, 2048]", "pixels: [1224, 1024]")
    old = "    type: hene_laser_expanded\n"
    if old not in text:
        raise SystemExit("the laser of the example stands otherwise in lab.yaml: mend this benchmark")
    lab.write_text(text.replace(old, f"{old}    parameters: {{power: 0.9 mW}}\n"))
    subprocess.run(["git", "config", "user.name", "Ada Lovelace"], cwd=folder, check=True)


def typed(words: list[str], folder: Path, environment: dict[str, str]) -> tuple[int, str]:
    """Run a command at a terminal that answers y to every question; return its exit code and what it wrote."""
    ours, theirs = pty.openpty()
    with subprocess.Popen(words, cwd=folder, env=environment, stdin=theirs, stdout=theirs, stderr=theirs) as running:
        os.close(theirs)
        said = b""
        while True:
            try:
                data = os.read(ours, 65536)
            except OSError:
                break
            if not data:
                break
            said += data
            if data.rstrip().endswith((b"]", b"?", b":")):
                os.write(ours, b"y\n")
    os.close(ours)
    return running.returncode, said.decode(errors="replace")


def main() -> int:
    """Run, print, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pace", type=float, default=10)
    parser.add_argument("--serve", type=Path, help=argparse.SUPPRESS)
    wanted = parser.parse_args()
    if wanted.serve:
        serve(wanted.serve)
        return 0
    environment = os.environ | {"PICO_EMULATED_PACE": str(wanted.pace), "NO_COLOR": "1"}
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        lab = Path(folder) / "lab"
        make_lab(lab, environment)
        own = [sys.executable, __file__, "--serve", str(lab)]
        with subprocess.Popen(own, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as world:
            assert world.stdout is not None
            assert world.stdout.readline() == "ready\n"
            only = ("--only", "devices", "--only", "identities", "--only", "motion")
            for words in (("commission", *only), ("apply", "E3-2"), ("apply", "E1-1"), ("apply", "E3-2")):
                began = time.monotonic()
                code, said = typed([*PICO, *REAL, *words], lab, environment)
                print(f"pico {' '.join(words)}: exit code {code}, {time.monotonic() - began:.0f} s", flush=True)
                if code not in (0, OPEN if words[0] == "commission" else 0):
                    print(said[-3000:])
                    wrong = max(wrong, MISSED if any(word in said for word in LATE) else 1, key=lambda n: n == 1)
            subprocess.run([*PICO, *REAL, "stop", "--now"], cwd=lab, env=environment, check=False, capture_output=True)
            note = lab / ".pico" / "benches" / "hardware" / "edge.json"
            if note.is_file():  # the process that guards light goes by itself only after a while
                os.kill(int(json.loads(note.read_text())["pid"]), signal.SIGTERM)
            world.kill()
    return wrong


if __name__ == "__main__":
    sys.exit(main())
