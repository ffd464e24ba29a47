"""Deformation: the contract of all methods, the table of them, and what they share."""
