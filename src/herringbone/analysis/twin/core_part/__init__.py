"""The condensed core of some parts as one part of a co-simulation, beside strangers."""
