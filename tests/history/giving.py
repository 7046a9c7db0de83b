"""The type of the `git` that tests of history are given."""

from __future__ import annotations

from collections.abc import Callable

Git = Callable[..., str]
