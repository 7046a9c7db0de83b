"""The least time that a plan can take, whatever its schedule."""

from __future__ import annotations

from collections import abc


def makespan_bound(arms: abc.Iterable[float], chains: abc.Iterable[float]) -> float:
    """Return a time before which no schedule ends [s].

    `arms`: for each arm a bound on what it needs for all of its operations one after the other, empty travel included
    (`lower_bound` of its sequence plus the loaded times). `chains`: the length of each chain of operations that wait
    for one another, as a motor's homing and drive. Arms and motors run side by side, so the longest of all is the
    bound.
    """
    return max((*arms, *chains), default=0.0)
