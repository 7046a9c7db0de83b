"""What `pico doctor` does about the files in which PICO keeps its state."""
