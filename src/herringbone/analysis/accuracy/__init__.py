"""Error against the twin, and what it costs: ladders of steps, speed-accuracy charts."""
