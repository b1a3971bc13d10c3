/* The flat CSV files that FMUs read: one "# units:" line, a header row, then rows.

   # units: load N, phase 1, stiffness N/m
   side,load,phase,stiffness
   left,56.306,0.0,8.22e8

   Grammar and messages are those of herringbone.components.resources.flat_csv. */
#ifndef FLAT_CSV_H
#define FLAT_CSV_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "component.h"
#include "message.h"

typedef struct {
    double *values;
    size_t count;
} Numbers;

/* Read a file and append its numbers: the index of the unit of each declared column, then the rows,
   columns in declared order, further ones in file order.

   shape: rows, columns.
   False, with a message, if the file is missing or malformed; `numbers` is unchanged then. */
bool flat_csv_read(const char *file, const HbText *grammar, Numbers *numbers, int64_t shape[2],
                   Message *message);

#endif
