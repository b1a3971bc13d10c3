"""Pictures of natural modes."""
