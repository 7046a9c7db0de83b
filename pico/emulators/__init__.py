"""Devices that are not there: each speaks the wire protocol of the real one, and what it does happens in the twin."""
