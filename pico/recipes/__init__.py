"""Recipes: executable experiments as YAML, checked before anything moves, and run step by step over a bench."""
