"""From a plan to its report: shown, approved, run with its progress on the screen, filmed."""
