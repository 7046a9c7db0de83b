"""Put the clone itself on the path of its environment, beside the editable install.

That finds `pico` after all folders of the path have been looked through. Started in the folder above a clone that is
called `pico`, Python would take that folder for a package without modules; a folder of the path wins over it.
"""

from __future__ import annotations

import sys
import sysconfig
from pathlib import Path

NAME = "pico_lab_clone.pth"


def main(packages: Path) -> None:
    """Write the file that adds the clone to the path into a folder of packages."""
    (packages / NAME).write_text(f"{Path(__file__).resolve().parent.parent}\n")


if __name__ == "__main__":
    main(Path(sys.argv[1] if sys.argv[1:] else sysconfig.get_path("purelib")))
