"""Instruments behind thin protocols: a driver a file, found by the entry point `pico.drivers`, imported on connect."""
