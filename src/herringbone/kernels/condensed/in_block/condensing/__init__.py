"""A component's equations condensed in its block: taken apart, in modes, checked, made steps."""
