"""Runs a plan: what must hold before, the walk of its graph, what an interruption leaves, and what became of it."""
