"""akap_editor."""
