"""What the compiled loop calls of a part in a cell: FMI 2.0 functions that make messages."""
