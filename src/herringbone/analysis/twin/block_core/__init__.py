"""The condensed core that a system as one component carries: its form, and its kernels."""
