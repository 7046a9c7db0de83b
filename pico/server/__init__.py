"""The coordinator: who has which bench, who may, and what was done, for clients and edges on a network."""
