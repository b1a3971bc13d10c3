"""The co-simulation master: systems, participants, schedule, compiled loop, algorithms, results.

It knows FMI and signals, and nothing of gears: it runs any FMU.
"""
