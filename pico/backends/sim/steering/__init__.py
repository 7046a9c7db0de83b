"""The simulated world while a person steers: it keeps pace with the wall, and its axes are read back all the way."""
