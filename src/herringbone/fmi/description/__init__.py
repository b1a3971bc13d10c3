"""modelDescription.xml of a component, made from its declaration alone."""
