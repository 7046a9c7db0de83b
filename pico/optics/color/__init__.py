"""What depends on wavelength: the range for which a part's numbers hold."""
