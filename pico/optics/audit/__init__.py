"""The beam audit: whether every branch of every laser ends where it is meant to, by `audit.audit`."""
