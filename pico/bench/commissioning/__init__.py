"""Taking a bench into use: a person is walked through it, step by step; a report is kept of what was found."""
