/* A CSV file, cut into fields; lines that are empty or start with # are left out. */
#ifndef CSV_TABLE_H
#define CSV_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "message.h"

typedef struct {
    size_t line, first, count; /* line in the file; fields[first ... first + count - 1] */
} Row;

typedef struct {
    const char *file;
    char *text;
    char *start; /* of what is read, at this line of the file */
    size_t first_line;
    char *units;  /* what follows "# units:" in the first line */
    char *header; /* what follows "# <header>:" in the last such line; NULL: there is none */
    size_t header_line;
    char **fields;
    Row *rows; /* the first one is the header */
    size_t field_count, row_count;
} Table;

/* Read a file, or the section of it behind the line "# section: ...", up to the next such line; NULL:
   all of it. `header` is the name of its header line, "": it has none. False, with a message, if
   there is none, its first line does not begin with "# units:", or a quote is not closed. Free the
   table in any case. */
bool csv_table_read(Table *table, const char *file, const char *section, const char *header,
                    Message *message);
void csv_table_free(Table *table);

/* Cut spaces off both ends, in place. */
char *csv_trim(char *text);
#define CSV_SPACE " \t\v\f"

#endif
