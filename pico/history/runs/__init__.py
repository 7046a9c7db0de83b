"""From the journal of a bench to the runs that commits carry, and back to what is known of each."""

from pico.history.runs.uncommitted import pending, standing_of, unrecorded

__all__ = ["pending", "standing_of", "unrecorded"]
