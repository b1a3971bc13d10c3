#include "csv_table.h"

#include <stdlib.h>
#include <string.h>

#include "platform.h"

char *csv_trim(char *text) {
    text += strspn(text, CSV_SPACE);
    size_t end = strlen(text);
    while (end > 0 && strchr(CSV_SPACE, text[end - 1]))
        text[--end] = '\0';
    return text;
}

/* End the line that starts here; returns the start of the next one, NULL at the end of the text. */
static char *end_line(char *line) {
    char *end = line + strcspn(line, "\r\n");
    if (*end == '\0')
        return NULL;
    char *next = end + (end[0] == '\r' && end[1] == '\n' ? 2 : 1);
    *end = '\0';
    return *next ? next : NULL;
}

/* End the field that starts at *cursor and move to the next one (NULL after the last one); quotes
   are taken off. NULL if a quote is not closed. */
static char *cut_field(char **cursor) {
    char *field = *cursor, *from = field, *to = field;
    if (*from == '"') {
        for (from++; *from != '"' || from[1] == '"'; *to++ = *from++) {
            if (*from == '\0')
                return NULL;
            from += *from == '"';
        }
        from++;
    }
    while (*from && *from != ',')
        *to++ = *from++;
    *cursor = *from ? from + 1 : NULL;
    *to = '\0';
    return field;
}

static bool cut_row(Table *table, char *line, size_t number, Message *message) {
    Row *row = &table->rows[table->row_count++];
    *row = (Row){.line = number, .first = table->field_count};
    for (char *cursor = line; cursor;) {
        char *field = cut_field(&cursor);
        if (!field) {
            message_write(message, "%s, line %zu: a quote is not closed", table->file, number);
            return false;
        }
        table->fields[table->field_count++] = field;
        row->count++;
    }
    return true;
}

static size_t count_of(const char *text, const char *characters) {
    size_t count = 0;
    for (; (text = strpbrk(text, characters)); text++)
        count++;
    return count;
}

static bool allocate(Table *table, Message *message) {
    size_t lines = count_of(table->start, "\r\n") + 1;
    table->rows = malloc(lines * sizeof *table->rows);
    table->fields = malloc((lines + count_of(table->start, ",")) * sizeof *table->fields);
    if (table->rows && table->fields)
        return true;
    message_write(message, "cannot read %s: out of memory", table->file);
    return false;
}

static bool cut_units(Table *table, Message *message) {
    static const char mark[] = "# units:";
    size_t length = strlen(mark);
    if (strncmp(table->start, mark, length) != 0 || strcspn(table->start + length, "\r\n") == 0) {
        message_write(message, "%s: the first line must be '# units: <column> <unit>, ...'",
                      table->file);
        return false;
    }
    table->units = table->start + length;
    return true;
}

/* Keep a comment line if it is the header line. */
static void keep_header(Table *table, char *line, size_t number, const char *header) {
    size_t length = strlen(header);
    if (length > 0 && strncmp(line, "# ", 2) == 0 && strncmp(line + 2, header, length) == 0 &&
        line[2 + length] == ':') {
        table->header = line + length + 3;
        table->header_line = number;
    }
}

static bool cut(Table *table, const char *header, Message *message) {
    if (!cut_units(table, message))
        return false;
    char *next = end_line(table->start);
    for (size_t number = table->first_line + 1; next; number++) {
        char *line = next;
        next = end_line(line);
        if (*line == '#')
            keep_header(table, line, number, header);
        else if (*line && !cut_row(table, line, number, message))
            return false;
    }
    return true;
}

static const char SECTION[] = "# section: ";

/* Start of the line behind this one; at the end of the text, that end. */
static char *line_behind(char *line) {
    char *end = line + strcspn(line, "\r\n");
    return end + (end[0] == '\r' && end[1] == '\n' ? 2 : *end != '\0');
}

static bool begins_section(const char *line, const char *section) {
    size_t length = strlen(SECTION);
    if (strncmp(line, SECTION, length) != 0)
        return false;
    size_t found = strcspn(line + length, "\r\n");
    return !section || (found == strlen(section) && !strncmp(line + length, section, found));
}

/* Narrow the text down to a section. */
static bool find_section(Table *table, const char *section, Message *message) {
    char *line = table->text;
    while (*line && !begins_section(line, section)) {
        line = line_behind(line);
        table->first_line++;
    }
    if (!*line) {
        message_write(message, "%s: it has no line '%s%s'", table->file, SECTION, section);
        return false;
    }
    table->start = line = line_behind(line);
    table->first_line++;
    while (*line && !begins_section(line, NULL))
        line = line_behind(line);
    *line = '\0';
    return true;
}

bool csv_table_read(Table *table, const char *file, const char *section, const char *header,
                    Message *message) {
    *table = (Table){.file = file, .text = platform_read_text(file, message), .first_line = 1};
    table->start = table->text;
    if (!table->text || (section && !find_section(table, section, message)))
        return false;
    return allocate(table, message) && cut(table, header, message);
}

void csv_table_free(Table *table) {
    free(table->text);
    free(table->fields);
    free(table->rows);
}
