"""Sections of the side panel about the rig of a drawing in layers."""
