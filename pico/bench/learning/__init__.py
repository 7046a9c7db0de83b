"""What the twin of a bench learns from runs of it."""
