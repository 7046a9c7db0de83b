"""The kernels: one file each, found by being here; see `pico.kernels.kernel.Kernel`. None imports numpy at its top."""
