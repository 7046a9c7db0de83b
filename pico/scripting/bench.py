"""What `pico.open` gives: a bench with all its services, and what makes a script short."""

from __future__ import annotations

from pico.bench.bench import Bench as Services
from pico.scripting.recording import Recording


class Bench(Services):
    """One bench, for scripts and notebooks. Every call blocks until it is done, and raises PicoError in words."""

    def record(self, name: str) -> Recording:
        """Return what makes one run of all that is done on the bench while it is entered.

        >>> with bench.record("scan") as run:
        ...     bench.apply("e1")
        """
        return Recording(self, name)
