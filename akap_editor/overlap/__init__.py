"""Which sheet of a bent drawing is in front where it overlaps itself."""
