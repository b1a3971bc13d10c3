"""The search for a periodic motion: where it begins, what it tries, what it says."""
