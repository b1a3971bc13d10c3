"""Pictures of studies: plain tables of many operating points."""
