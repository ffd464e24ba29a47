"""The window: main loop, panels, theme."""
