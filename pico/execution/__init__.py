"""Runs a plan on a backend: checks, the walk of the graph, interruption, and what became of it."""

from pico.execution.run import run

__all__ = ["run"]
