"""Arms as they are built: where their tools really are, and what their joints are told so that nobody notices."""
