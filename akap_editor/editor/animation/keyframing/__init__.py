"""What makes keyframes, copies them, and shows those before and after the playhead."""
