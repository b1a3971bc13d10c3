"""The condensed core on its march: first guesses, and motions that it repeats."""
