"""Documents of runs for tests, by hand and at random."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from pico.model.diff import Change
from pico.model.plan import LabRef
from pico.model.trace.expectation import Expected
from pico.model.trace.run import Artifact, Cause, Run, Seen, TraceEvent

A, B = "sha256:" + "a" * 64, "sha256:" + "b" * 64


def run_document(**fields: Any) -> Run:
    """Return a document with some fields of one's own."""
    known: dict[str, Any] = {
        "id": "20261121T101155Z-af9bba", "lab": LabRef(name="shel", digest=A), "state_before": A, "state_after": B,
        "plan": A, "evidence": "kinematic", "started_at": "2026-11-21T10:11:55Z", "outcome": "done",
    }  # fmt: skip
    return Run(**(known | fields))


_TEXT = st.text(st.characters(codec="utf-8"), max_size=20)
_NUMBER = st.integers(-(10**9), 10**9).map(lambda n: n / 1000)
_HASH = st.text("0123456789abcdef", min_size=64, max_size=64)
_DIGEST = _HASH.map(lambda h: f"sha256:{h}")
_VALUE = (
    st.none() | st.booleans() | _NUMBER | _TEXT | st.fixed_dictionaries({"x": _NUMBER, "y": _NUMBER, "yaw": _NUMBER})
)
_CHANGE = st.builds(
    Change, component=_TEXT, tunable=_TEXT, before=_VALUE, after=_VALUE, text=_TEXT, tolerated=st.booleans()
)
_NAMED = st.dictionaries(_TEXT, _TEXT, max_size=3)

DOCUMENTS = st.builds(
    run_document,
    id=st.from_regex(r"[0-9]{8}T[0-9]{6}Z-[0-9a-f]{6}(-r[1-9])?", fullmatch=True),
    parent=st.none() | _HASH.map(lambda h: h[:40]),
    state_before=_DIGEST,
    state_after=_DIGEST,
    observed=st.none() | st.builds(Seen, at=_TEXT, state=_DIGEST, looked=st.booleans()),
    goal=_TEXT,
    cause=st.builds(Cause, kind=_TEXT, of=st.none() | _TEXT),
    evidence=st.sampled_from(["kinematic", "physics", "emulated", "hardware"]),
    seed=st.none() | st.integers(0, 2**31),
    operator=_TEXT,
    environment=_NAMED,
    versions=_NAMED,
    outcome=st.sampled_from(["done", "failed", "interrupted", "killed"]),
    seconds=_NUMBER,
    tally=st.dictionaries(_TEXT, st.integers(0, 1000), max_size=3),
    resumed=st.integers(0, 9),
    expectations=st.lists(
        st.builds(Expected, that=_TEXT, message=_TEXT, holds=st.none() | st.booleans(), why=_TEXT), max_size=2
    ).map(tuple),
    changes=st.lists(_CHANGE, max_size=3).map(tuple),
    afterwards=st.lists(_CHANGE, max_size=1).map(tuple),
    artifacts=st.lists(
        st.builds(Artifact, name=_TEXT, sha256=_HASH, size=st.integers(0, 10**12), shape=st.none() | st.just((2, 3))),
        max_size=2,
    ).map(tuple),
)

EVENTS = st.lists(
    st.builds(
        TraceEvent, t=_NUMBER, at=_TEXT, seq=st.integers(1, 10**6), kind=_TEXT, operation=st.none() | _TEXT,
        attempt=st.none() | st.integers(1, 9), component=st.none() | _TEXT,
        data=st.dictionaries(_TEXT, _VALUE, max_size=3),
    ),
    max_size=5,
)  # fmt: skip
