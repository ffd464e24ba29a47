"""Reads pictures in layers."""
