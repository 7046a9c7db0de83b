"""The judges of a plan: one list, which a client asks when it plans and an edge before anything moves."""
