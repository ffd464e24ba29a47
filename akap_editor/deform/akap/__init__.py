"""As-Killing-as-possible deformation: the method of the paper, and memory of the rest pose."""
