"""The dialogs that export a pose or an animation."""
