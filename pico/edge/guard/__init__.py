"""The guard's part of an edge: the journal of what it ended, its own process, and the lock of a person at the table."""
