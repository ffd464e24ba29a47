"""The rig of a drawing in layers: joints, and proposals for them."""
