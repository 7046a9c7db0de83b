"""What becomes of a plan: its run, the events that tell of it, what was expected, and the report at its end."""
