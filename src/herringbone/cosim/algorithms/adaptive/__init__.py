"""`li` with macro steps whose lengths follow a tolerance."""
