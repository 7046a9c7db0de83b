"""What each optical element does to a beam: one file each, found by its name; see `pico.optics.part.Element`."""
