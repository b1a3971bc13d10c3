"""What levels depend on."""
