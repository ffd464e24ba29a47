"""From a picture to a triangle mesh of what is visible of it."""
