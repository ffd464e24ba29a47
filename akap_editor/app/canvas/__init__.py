"""The canvas: pointer input, pins, overlays and the drawn scene."""
