"""What must hold before anything moves, and what is expected afterwards."""
