"""What finds the best point: one algorithm a file, found by being here; see `pico.optimize.problem`."""
