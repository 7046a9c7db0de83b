"""Write the table of the guard into docs/how-to/laser-safety.md, as `benchmarks/safety_chain.py` judges its cells.

`--check` only says whether it is there as it should be.
"""

from __future__ import annotations

import runpy
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "how-to" / "laser-safety.md"
BEGIN, END = "<!-- made by `make docs` -->", "<!-- end of what `make docs` made -->"


def page() -> str:
    """Return the page with the table as it should be."""
    made = runpy.run_path(str(ROOT / "benchmarks" / "safety_chain.py"))["table"]()
    before, _, rest = PAGE.read_text().partition(BEGIN)
    return f"{before}{BEGIN}\n{made}\n{END}{rest.partition(END)[2]}"


if __name__ == "__main__":
    import sys

    from printing import printed

    sys.exit(printed(PAGE, page()))
