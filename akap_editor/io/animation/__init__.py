"""Animation files: frames, animated pictures, videos and sprite sheets."""
