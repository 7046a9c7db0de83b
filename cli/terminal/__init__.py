"""Who sits there: what is written and read, pagers, editors, waiting, and signals that end a command."""
