"""How the guides become a site: `python -m sphinx -W docs build/docs`."""

from importlib import metadata

project = "herringbone"
author = "herringbone developers"
release = metadata.version("herringbone")
extensions = ["myst_parser"]
exclude_patterns = ["conf.py"]
myst_heading_anchors = 3
html_theme = "alabaster"
html_theme_options = {"description": "Guides for those who extend it", "page_width": "60rem"}
html_show_sourcelink = False
