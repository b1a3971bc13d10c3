"""Files of gear pairs: gear files, REXS, and the data of the component gear_mesh."""
