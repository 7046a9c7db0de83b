"""Set-points that are more than numbers."""
