"""Hand-written hosts of FMUs: what any tool does with one, and nothing else."""
