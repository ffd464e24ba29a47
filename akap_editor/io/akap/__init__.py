"""Files of this program: documents, poses, recordings and recovery copies."""
