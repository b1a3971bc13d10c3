"""Long searches for what breaks, by hand; see README.md."""
