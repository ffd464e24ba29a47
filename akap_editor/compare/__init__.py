"""Compares deformation methods on recordings: replays, measures, and reports."""
