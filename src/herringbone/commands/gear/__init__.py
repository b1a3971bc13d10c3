"""The command `gear`."""
