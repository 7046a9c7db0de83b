"""What the coordinator answers, a file a subject."""
