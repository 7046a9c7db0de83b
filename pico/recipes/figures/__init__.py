"""Figures of what a run of a recipe returned, its commits and its trace."""
