"""The sensor of a camera: counts of the light that falls on it, by `sensor.frame`, with their noise."""
