"""The kernels, a file each, found by being there: see `pico.kernels.pipeline.Step`."""
