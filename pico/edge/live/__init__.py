"""How an edge tells where everything is, for who draws its bench."""
