"""Runs a plan on a backend: checks, the walk of the graph, interruption, and what became of it."""
