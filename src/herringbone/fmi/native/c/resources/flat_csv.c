#include "flat_csv.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "csv_table.h"
#include "platform.h"

/* Index of the unit that the file gives for a column; -1 with a message if it takes no such unit. */
static int unit_index(const Table *table, const HbColumn *column, Message *message) {
    char unit[64] = "none";
    for (const char *item = table->units; *item; item += *item == ',') {
        size_t length = strcspn(item, ",");
        char copy[128];
        snprintf(copy, sizeof copy, "%.*s", (int)(length < sizeof copy ? length : sizeof copy), item);
        char *name = csv_trim(copy), *rest = name + strcspn(name, CSV_SPACE);
        if (*rest) {
            *rest = '\0';
            if (strcmp(name, column->name) == 0)
                snprintf(unit, sizeof unit, "%.*s", (int)sizeof unit - 1, csv_trim(rest + 1));
        }
        item += length;
    }
    char wanted[256] = "";
    for (int k = 0; column->units[k]; k++) {
        if (strcmp(unit, column->units[k]) == 0)
            return k;
        size_t used = strlen(wanted);
        snprintf(wanted + used, sizeof wanted - used, "%s%s", k ? " or " : "", column->units[k]);
    }
    message_write(message, "%s: column '%s' has unit '%s' in the '# units:' line; it takes %s",
                  table->file, column->name, unit, wanted);
    return -1;
}

static bool has_rest(const HbText *grammar) {
    return grammar->column_count && grammar->columns[grammar->column_count - 1].rest;
}

/* Names in a list of the form a, b, c; empty ones are left out. */
static void list_name(char *list, size_t size, const char *name) {
    size_t used = strlen(list);
    if (*name)
        snprintf(list + used, size - used, "%s%s", used ? ", " : "", name);
}

static size_t find_field(const Table *table, const char *name) {
    size_t i = 0;
    while (i < table->rows->count && strcmp(table->fields[i], name) != 0)
        i++;
    return i;
}

static const HbColumn *declared_column(const HbText *grammar, const char *name) {
    for (uint32_t k = 0; k < grammar->column_count; k++)
        if (!grammar->columns[k].rest && strcmp(grammar->columns[k].name, name) == 0)
            return &grammar->columns[k];
    return NULL;
}

/* List the missing columns of words, or of numbers. */
static void list_missing(const Table *table, const HbText *grammar, bool words, char *list,
                         size_t size) {
    for (uint32_t k = 0; k < grammar->column_count; k++) {
        const HbColumn *column = &grammar->columns[k];
        if (!column->rest && (column->words != NULL) == words &&
            find_field(table, column->name) == table->rows->count)
            list_name(list, size, column->name);
    }
}

static bool check_header(const Table *table, const HbText *grammar, Message *message) {
    char missing[256] = "", extra[256] = "", all[256] = "";
    size_t unknown = 0;
    for (size_t i = 0; i < table->rows->count; i++) {
        const char *name = table->fields[i];
        list_name(all, sizeof all, name);
        if (find_field(table, name) < i) {
            message_write(message, "%s: column %s stands twice", table->file, name);
            return false;
        }
        if (!declared_column(grammar, name)) {
            list_name(extra, sizeof extra, name);
            unknown++;
        }
    }
    list_missing(table, grammar, true, missing, sizeof missing);
    list_missing(table, grammar, false, missing, sizeof missing);
    if (*missing)
        message_write(message, "%s: column %s is missing; it has %s", table->file, missing, all);
    else if (unknown && !has_rest(grammar))
        message_write(message, "%s: column %s is unknown", table->file, extra);
    else
        return true;
    return false;
}

/* Place of every column of the file in a row of numbers. */
static void arrange(const Table *table, const HbText *grammar, size_t place[]) {
    size_t next = grammar->column_count - (has_rest(grammar) ? 1 : 0);
    for (size_t i = 0; i < table->rows->count; i++) {
        const HbColumn *column = declared_column(grammar, table->fields[i]);
        place[i] = column ? (size_t)(column - grammar->columns) : next++;
    }
}

static bool read_word(const char *file, const HbColumn *column, const char *word, double *value,
                      Message *message) {
    char known[256] = "";
    for (int k = 0; column->words[k]; k++) {
        *value = k;
        if (strcmp(word, column->words[k]) == 0)
            return true;
        list_name(known, sizeof known, column->words[k]);
    }
    *value = -1.0;
    if (!column->other_words)
        message_write(message, "%s: %s '%.64s' is none of %s", file, column->name, word, known);
    return column->other_words;
}

static bool read_number(const Table *table, const Row *row, size_t i, double *value,
                        Message *message) {
    const char *field = table->fields[row->first + i];
    if (platform_number(field, value))
        return true;
    message_write(message, "%s, line %zu: %s = '%.64s' is not a finite number", table->file,
                  row->line, table->fields[i], field);
    return false;
}

/* Read the words of a row, or its numbers. */
static bool read_row(const Table *table, const Row *row, const HbText *grammar, bool words,
                     const size_t place[], double values[], Message *message) {
    if (row->count != table->rows->count) {
        message_write(message, "%s, line %zu: %zu fields, %zu expected", table->file, row->line,
                      row->count, table->rows->count);
        return false;
    }
    for (size_t i = 0; i < row->count; i++) {
        const HbColumn *column = declared_column(grammar, table->fields[i]);
        bool word = column && column->words;
        if (word != words)
            continue;
        char *field = table->fields[row->first + i];
        if (!(word ? read_word(table->file, column, csv_trim(field), &values[place[i]], message)
                   : read_number(table, row, i, &values[place[i]], message)))
            return false;
    }
    return true;
}

static bool read_rows(const Table *table, const HbText *grammar, double values[],
                      Message *message) {
    size_t columns = table->rows->count;
    size_t *place = malloc(columns * sizeof *place);
    if (!place) {
        message_write(message, "cannot read %s: out of memory", table->file);
        return false;
    }
    arrange(table, grammar, place);
    bool read = true;
    for (int words = 0; words < 2; words++) /* a number that is none is told first */
        for (size_t r = 1; read && r < table->row_count; r++)
            read = read_row(table, &table->rows[r], grammar, words, place,
                            values + (r - 1) * columns, message);
    free(place);
    return read;
}

static bool read_units(const Table *table, const HbText *grammar, double values[],
                       Message *message) {
    for (uint32_t k = 0; k < grammar->column_count; k++) {
        int index = grammar->columns[k].units ? unit_index(table, &grammar->columns[k], message) : 0;
        if (index < 0)
            return false;
        values[k] = index;
    }
    return true;
}

/* Read the numbers of the header line; NaN if the file has none. */
static bool read_header(const Table *table, const HbText *grammar, double values[],
                        Message *message) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < grammar->header_count; k++)
        values[k] = NAN;
    if (!table->header)
        return true;
    for (char *word = table->header + strspn(table->header, CSV_SPACE); *word; count++) {
        char *end = word + strcspn(word, CSV_SPACE), *next = end + strspn(end, CSV_SPACE);
        *end = '\0';
        if (count == grammar->header_count || !platform_number(word, &values[count]))
            break;
        word = next;
        if (!*word && count + 1 == grammar->header_count)
            return true;
    }
    message_write(message, "%s, line %zu: '# %s:' takes %u finite numbers", table->file,
                  table->header_line, grammar->header, (unsigned)grammar->header_count);
    return false;
}

/* Room for more numbers behind those that count; NULL with a message if memory is short. */
static double *grow(Numbers *numbers, size_t more, const char *file, Message *message) {
    double *values = realloc(numbers->values, (numbers->count + more) * sizeof *values);
    if (!values) {
        message_write(message, "cannot read %s: out of memory", file);
        return NULL;
    }
    numbers->values = values;
    return values + numbers->count;
}

static bool append(const Table *table, const HbText *grammar, Numbers *numbers, int64_t shape[2],
                   Message *message) {
    size_t declared = grammar->column_count;
    double *values = grow(numbers, declared, table->file, message);
    if (!values)
        return false;
    if (table->row_count < 2) {
        message_write(message, "%s: it has no rows", table->file);
        return false;
    }
    for (size_t i = 0; i < table->rows->count; i++)
        table->fields[i] = csv_trim(table->fields[i]);
    if (!check_header(table, grammar, message) || !read_units(table, grammar, values, message))
        return false;
    size_t rows = table->row_count - 1, first = declared + grammar->header_count;
    size_t count = first + rows * table->rows->count;
    values = grow(numbers, count, table->file, message);
    if (!values || !read_rows(table, grammar, values + first, message) ||
        !read_header(table, grammar, values + declared, message))
        return false;
    numbers->count += count;
    shape[0] = (int64_t)rows;
    shape[1] = (int64_t)table->rows->count;
    return true;
}

bool flat_csv_read(const char *file, const HbText *grammar, Numbers *numbers, int64_t shape[2],
                   Message *message) {
    Table table;
    bool read = csv_table_read(&table, file, grammar->section, grammar->header, message) &&
                append(&table, grammar, numbers, shape, message);
    csv_table_free(&table);
    return read;
}
