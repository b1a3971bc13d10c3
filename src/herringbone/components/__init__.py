"""The physical components: one file each with declaration, equations and kernels; registry."""
