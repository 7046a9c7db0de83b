"""What is computed from a picture or from readings: kernels, pure maps to numbers with their uncertainties.

Each is a file of `pico.kernels.steps`, or comes with a plug-in by the entry point `pico.kernels`. They are composed as
text, `image | background | centroid`, see `pico.kernels.pipeline`.
"""
