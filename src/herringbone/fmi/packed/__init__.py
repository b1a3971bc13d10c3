"""What lies in a native FMU besides description, binaries and resources."""
