"""Which configuration broke an expectation: trials on the bench, chosen by what they cost, kept by git."""

from pico.bench.bisecting.begin import begin, under_way
from pico.bench.bisecting.records import BisectionOutcome, BisectionTask, Proposal, Tried
from pico.bench.bisecting.search import Bisection

__all__ = ["Bisection", "BisectionOutcome", "BisectionTask", "Proposal", "Tried", "begin", "under_way"]
