"""What stands before every request: which hosts and origins are answered, how much may be said, and how often."""
