"""Running one system: loading, starting, recording, reporting, exporting."""
