"""The macro step of a run, and what it errs by other runs."""
