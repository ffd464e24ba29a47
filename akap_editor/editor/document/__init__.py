"""The open document: immutable values that are replaced, never changed."""
