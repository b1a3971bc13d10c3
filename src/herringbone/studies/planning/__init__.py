"""Plans: as much model, and the solver, that what a scene asks needs, certified."""
