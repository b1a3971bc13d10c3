"""What is computed about a system beside the co-simulation: twin, equilibrium, spectra."""
