"""The compiled loops of the algorithms, and what they are made of."""
