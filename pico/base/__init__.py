"""What knows no lab: the clock, formats of documents, and the files in which PICO keeps its state."""
