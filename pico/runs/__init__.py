"""What happened on the way from one state to the next: runs, their measurements, and the large data that they took."""
