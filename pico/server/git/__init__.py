"""The bare repository of each lab at the coordinator."""
