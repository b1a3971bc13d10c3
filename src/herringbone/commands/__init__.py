"""The commands of the command line, one file each: parsing, and what they show."""
