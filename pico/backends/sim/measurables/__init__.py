"""What the simulator can measure: one file each, found by being here; see `pico.backends.sim.readings`."""
