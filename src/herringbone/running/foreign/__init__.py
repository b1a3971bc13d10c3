"""Foreign FMUs of a system that is run: what they are, and what stands for them."""
