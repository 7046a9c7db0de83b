"""Measurement kernels: pure maps from a picture or from readings to numbers with their uncertainties. Kernels are files
of `pico.kernels.standard`; `pico.kernels.pipeline` chains them by text: `image | background | centroid`."""
