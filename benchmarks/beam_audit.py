"""How long the beam audit takes of each shipped laboratory with its laser on, and how many branches it follows.

    python benchmarks/beam_audit.py [--repeat 20]

Each cell is the median, in a process that has imported all. The bar is 0.5 s for the bench of the case study. That of
`crowded` has a mirror that may turn a strong beam over its range, and is traced ten times.
"""

from __future__ import annotations

import argparse
import statistics
import time

from pico.manifest.load import load_folder
from pico.model.state import place_of
from pico.optics.audit.audit import audit
from pico.resources import labs_dir


def main() -> None:
    """Print a row for each laboratory."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=20)
    repeat = parser.parse_args().repeat
    print(f"{'lab':<14}{'audit':>10}  findings")
    for folder in sorted(path.parent for path in labs_dir().glob("*/lab.yaml")):
        setup, state = load_folder(folder).require()
        poses = {name: place_of(setup, state, name)[1] for name in setup.lab.inventory}
        values = {name: part.values for name, part in state.components.items()}
        lasers = [name for name in poses if setup.type_of(name).optics.element == "source"]
        times = []
        for _ in range(repeat + 1):
            begun = time.perf_counter()
            found = audit(setup, poses, values, lasers)
            times.append(time.perf_counter() - begun)
        print(f"{folder.name:<14}{1000 * statistics.median(times[1:]):>7.1f} ms  {len(found.findings)}")


if __name__ == "__main__":
    main()
