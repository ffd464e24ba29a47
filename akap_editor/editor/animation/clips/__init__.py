"""Clips: motions of named pins, which are applied to other drawings."""
