"""Pictures in layers, and their composition into one picture."""
