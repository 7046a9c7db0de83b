"""What the coordinator answers, a file a subject; each is found by being there (`known`)."""
