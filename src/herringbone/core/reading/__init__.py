"""The boundary for files of strangers: archives, XML, texts, TOML and JSON, numbers.

Each has one opener. Whatever is wrong with a file becomes one line of the error tree: which file,
where in it, what, and what to do. Sizes are limited before memory is taken.
"""
