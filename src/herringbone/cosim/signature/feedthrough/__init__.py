"""What of a part's inputs its outputs show at once: at the start, later, and under noise."""
