"""The guard: ends light when a safety input opens or falls silent, whatever runs and whoever listens."""
