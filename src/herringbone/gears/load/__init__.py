"""What a loaded pair shows: transmission error, load on the flanks, dynamic factor."""
