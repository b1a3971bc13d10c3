"""Cells: child processes in which foreign FMUs are loaded, probed and run.

A foreign FMU that crashes, exits or never returns takes its cell with it, not the run. A cell is a
Python process with one block of memory that it shares with the master:

- the master posts a message by a counter, the cell answers by another one; whoever waits spins for
  a short time, then sleeps in the kernel (futex), and the master looks at the clock and at the
  life of the cell meanwhile (`waiting`);
- what the compiled loop calls are adapters at C addresses (`calls`). They collect what needs no
  answer (set, save, restore, free) and send it with the next step, together with a request for the
  outputs that were read before: one message per part and sweep. Nobody waits for it until these
  are read, so that other parts step meanwhile. The cell's side is compiled, too (`inside.serving`);
- all else (instantiate, initialise, values of other types, terminate, free) goes as JSON through
  the same block (`wire`, `process`, `inside.child`).

No descriptor is needed after the start, so that an FMU may close them all. A refusal of what was
collected is reported by the step that it was sent with; the first call of every kind is sent at
once. A cell keeps a run from harm by faults; it is no sandbox against malice.
"""
