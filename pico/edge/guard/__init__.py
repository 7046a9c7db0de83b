"""The guard's part of an edge: the journal of what it ended, and the lock of a person at the table."""
