"""Compiles the loops of the package, so that several workers of the tests need not do it at once."""

from akap_editor.app.jobs.engine_preparation import PARTS, start_child

if __name__ == "__main__":
    for child in [start_child(part) for part in PARTS]:
        child.communicate()
