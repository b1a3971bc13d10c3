"""How kernels are compiled, kept and linked."""
