"""Linear models of foreign parts, identified from trial steps, and parts made of them."""
