"""The page for browsers, as it was built of `ui/`: what it shows it asks for as any client does."""
