"""Files of gear pairs: gear files, REXS, and the data that a gear pair reads."""
