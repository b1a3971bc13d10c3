"""What runs in a cell, and the machine code of it."""
