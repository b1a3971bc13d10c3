"""The monolithic twin by its condensed core: the linear rest exact, the laws collocated."""
