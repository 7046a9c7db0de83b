"""From the journal of a bench to the runs that commits carry, and back to what is known of each."""

from pico.history.runs.uncommitted import awaited, pending, standing_of, unrecorded

__all__ = ["awaited", "pending", "standing_of", "unrecorded"]
