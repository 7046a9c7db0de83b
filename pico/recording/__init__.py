"""From the journal of a bench to the runs that commits carry, and back to what is known of each."""

from pico.recording.pending import evidence_of, pending, standing_of, unrecorded

__all__ = ["evidence_of", "pending", "standing_of", "unrecorded"]
