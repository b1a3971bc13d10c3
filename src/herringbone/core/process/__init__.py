"""What concerns this process as a whole: lines while it works, threads, memory, its termination."""
