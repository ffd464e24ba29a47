"""Pure functions on arrays: outlines, meshes, differential operators, distortion."""
