"""Entries: which assumptions that the thesis does not publish make its sentences hold."""
