"""The cache of generated artefacts: keys, files written whole, syntax of sources, modules."""
