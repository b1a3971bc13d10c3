"""What leaves as a file for other tools: systems as SSP, a system as one FMU."""
