"""Dialogs; each owns its state."""
