"""The energy that the coupling adds: what is watched, and its compiled bookkeeping."""
