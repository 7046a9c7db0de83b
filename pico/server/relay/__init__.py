"""What the coordinator hands on between clients and the edges that are connected."""
