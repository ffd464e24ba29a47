"""The triangle mesh of a picture: background removal, outlines, triangulation, quality."""
