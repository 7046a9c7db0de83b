"""Which configuration broke an expectation: trials on the bench, chosen by what they cost, kept by git."""

from pico.bisecting.begin import begin, under_way
from pico.bisecting.records import Outcome, Proposal, Task, Tried
from pico.bisecting.search import Bisection

__all__ = ["Bisection", "Outcome", "Proposal", "Task", "Tried", "begin", "under_way"]
