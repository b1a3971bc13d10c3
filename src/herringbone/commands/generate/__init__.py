"""All that is generated and committed: `python -m herringbone.commands.generate`."""
