"""What sensors show of a run: their signals, and figures of these."""
