"""Commands that study a system: modes, steady states, sweeps."""
