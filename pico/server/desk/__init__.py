"""Desks: checkouts of a lab at the coordinator, where `pico` is run for somebody who has none."""
