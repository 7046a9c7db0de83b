"""A bench as a physicist writes it in Python: parts and tunables as objects, one run of all that a script does."""
