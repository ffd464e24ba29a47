"""Arrays to pixels, given an OpenGL context."""
