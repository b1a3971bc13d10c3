"""Speed-accuracy charts: algorithms, steps and cores up a ladder of costs."""
