"""The large data of a lab's runs: what is needed, where it is, bringing it from here to there, and looking after it."""
