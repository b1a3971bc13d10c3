"""FMUs 3.0 as participants, behind the functions of FMI 2.0."""
