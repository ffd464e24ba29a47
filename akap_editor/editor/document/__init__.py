"""What an open drawing is: frozen values, replaced and never edited."""
