"""Closed-loop optimization: algorithms that are asked what to try and told what was measured, and the safe loop."""
