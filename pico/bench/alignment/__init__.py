"""What the bench's own values are: those that met goals found, and that plans leave where they are."""
