"""The command check: an FMU, the contract of a role, a flange."""
