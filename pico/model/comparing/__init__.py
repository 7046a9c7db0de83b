"""How the live bench differs from a state: what a person is told of it."""
