"""What pictures of a bench show."""
