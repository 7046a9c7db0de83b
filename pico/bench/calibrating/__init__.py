"""The calibration of a bench with devices, step by step, with a person at the table."""
