"""The condensed core: linear parts advanced exactly, laws collocated; arrays only."""
