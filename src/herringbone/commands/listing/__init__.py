"""What there is: components, systems, scenes, algorithms, studies."""
