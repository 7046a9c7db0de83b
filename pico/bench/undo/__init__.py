"""Taking runs back, and taking that back: which run, whether its changes are still in place, and the plan."""
