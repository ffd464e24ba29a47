"""Meshes of other programs: OBJ and OFF are opened and written; these, glTF and JSON are inspected."""
