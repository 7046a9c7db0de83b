"""What a calibration finds, and how each result came about."""
