"""Natural modes of a system at rest in its rotation: frequencies, participation, shapes."""
