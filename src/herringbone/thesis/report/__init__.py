"""The report of the thesis' studies: one HTML file, data beside it, pages for the docs."""
