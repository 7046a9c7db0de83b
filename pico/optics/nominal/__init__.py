"""What a bench as it is thought of says of light: how numbers answer tunables and placements."""
