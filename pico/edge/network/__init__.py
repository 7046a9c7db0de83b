"""A bench on the network: what its clients, and its edge, need to reach the coordinator that they share."""
