"""Speed, measured side by side in one run: what `herringbone bench` prints."""
