"""The results folder: rows that are there while a run goes on, and all about them in the end."""
