"""What a client and an edge say to one another: leases, who has a bench, its Lab, what a run is to do. For what may be
asked of an edge see `pico.edge.contract`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, Protocol

from pico.diagnostics import PicoError
from pico.model.plan import Plan
from pico.model.record import record


class Cut(PicoError):
    """The line to an edge is cut: what it does goes on, and may be asked of again once it is there."""


@record
class Lease:
    """The right to move a bench. Every mutating call carries its token; tokens of a bench strictly increase."""

    token: int
    holder: str
    since: str


@record
class Holder:
    """Who has the bench: the lease's token, the user, the process, since when, and what for. `server`: the process is
    the one that serves the bench, for a client of that user."""

    token: int
    user: str
    pid: int
    since: str
    what: str
    server: bool = False

    @property
    def who(self) -> str:
        """`ann (process 12)`."""
        return f"{self.user} ({'the server of this bench, ' if self.server else ''}process {self.pid})"

    @property
    def said(self) -> str:
        """`ann (process 12, since 2026-11-23T07:00:00Z): pico apply`."""
        return f"{self.who[:-1]}, since {self.since}): {self.what}" if self.pid else "another process"


STEERING = "pico teleop"
"""For which a bench is taken, and what, where a person steers."""
RECORDING = "recording"
"""For which a bench is taken, and what, where a script has an open run."""
RECIPE = "pico run"
"""For which a bench is taken, and for which recipe, where one runs."""


class Granting(Protocol):
    """Who grants a bench that is enrolled with a coordinator, in place of its own counting of tokens."""

    def token(self) -> int:
        """Return the token under which the bench is taken now; raises PicoError (exit code LOCKED) for a lease that is
        over."""
        ...

    def require(self, *, under_way: bool = False) -> None:
        """Raise PicoError (exit code INTERRUPTED) where nothing may begin to move now; `under_way`: no step of what
        began before."""
        ...


@record
class OwnLab:
    """The Lab that a bench keeps as its own, with its component types: the files that describe it, as text by their
    path in the lab's folder; who adopted it, and when (empty: it was not adopted yet)."""

    files: Mapping[str, str]
    by: str = ""
    at: str = ""

    def as_bytes(self) -> dict[str, bytes]:
        """Return the files as they stand on a disk."""
        return {name: text.encode("utf-8", "surrogateescape") for name, text in self.files.items()}


@record
class Job:
    """What a run is to do: a plan, for `holder`.

    `resumes`: the run of this id goes on, which is known. `stop_on_error`: the first failure lets nothing more start.
    `filmed`: what moves is kept for a film. `wait`: so long it waits for the bench where somebody has it [s].
    `speed`: share of the joint limits that the plan was made for, instead of the lab's. `within`: the id of the open
    run that this is a step of, see `pico.edge.contract.EdgeRuns.open`.
    """

    plan: Plan
    holder: str
    resumes: bool = False
    stop_on_error: bool = False
    filmed: bool = False
    wait: float = 0.0
    speed: float | None = None
    within: str | None = None


Asking = Literal["safely", "now"]
"""How a run is stopped from elsewhere. `safely`: as by the first Ctrl-C; `now`: as by the second."""
