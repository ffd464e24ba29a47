"""As-Killing-as-possible deformation: the method of the paper."""
