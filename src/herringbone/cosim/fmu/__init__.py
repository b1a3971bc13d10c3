"""FMUs as participants: files from strangers, checked, opened and called."""
