"""The simulated person at the bench."""
