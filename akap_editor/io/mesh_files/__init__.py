"""Meshes of other programs: OBJ, OFF, glTF and JSON."""
