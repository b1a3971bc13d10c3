"""What a run of a condensed system records, from its modal coordinates."""
