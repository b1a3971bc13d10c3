"""A network as flat arrays: what the compiled loops work on."""
