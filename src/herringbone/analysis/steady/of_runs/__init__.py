"""What runs with foreign parts settle to."""
