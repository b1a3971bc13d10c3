"""Where files are: folders, paths from others, temporary files."""
