"""Pointer tools: named states that turn events into edits."""
