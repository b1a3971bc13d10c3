"""Where a run goes: its folder, what may be overwritten, its rows and its report."""
