"""Pure functions on arrays: triangle meshes, differential operators, distortion, validation."""
