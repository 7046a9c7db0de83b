"""The cheapest order of operations under precedence, with a bound; knows nothing of tables and robots."""

from pico.staging.sequencing.problem import Effort, Sequence
from pico.staging.sequencing.solve import best_order, tightened

__all__ = ["Effort", "Sequence", "best_order", "tightened"]
