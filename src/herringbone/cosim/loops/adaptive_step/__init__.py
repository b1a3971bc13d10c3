"""The compiled loop with a macro step that follows a tolerance: its ladder, error and choice."""
