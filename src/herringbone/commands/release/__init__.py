"""What a release is made of; see `release.__main__`."""
