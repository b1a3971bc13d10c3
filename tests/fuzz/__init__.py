"""Damaged files of strangers, made of good ones; every reader refuses them in one line."""
