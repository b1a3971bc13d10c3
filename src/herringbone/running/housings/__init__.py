"""Housings put into a system: which ones, what FMUs among them are told of, and rigid ground."""
