"""How a document looks over time: motions, playback, keyframes."""
