"""What pages are shown of benches: one stream from an edge, however many watch."""
