"""Where PICO keeps what it knows on disk: of a lab's checkout, and of each bench of it."""
