"""Plug-ins: the one place that loads what an entry point of PICO names, and that calls it."""
