"""Foreign FMUs of tests, in C and Python, and systems of them."""
