"""Eigenvalues and eigenvectors of real matrices, in the kernel language."""
