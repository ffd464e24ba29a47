"""What happens to a document: steps, edits, undo, recording and replay."""
