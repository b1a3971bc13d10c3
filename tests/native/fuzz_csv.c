/* Feeds mutated resource files to the reader: each is read, or refused with one line. */
#include <stdlib.h>
#include <unistd.h>

#include "check.h"
#include "component.h"
#include "flat_csv.h"

enum { CASES = 8000, LARGEST = 4096 };

static unsigned long long state = 0x9E3779B97F4A7C15u;

static size_t below(size_t limit) {
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return (size_t)(state % limit);
}

static size_t mutate(char *text, size_t size) {
    static const char *const pieces[] = {",", "\"", "\n", "\r", "# units:", "-", "e999", "nan", ".",
                                         "\xEF\xBB\xBF", "\xFF", "left", "mass kg", "\"\"", " ",
                                         "99999999999999999999999999999999", "speed", "shape", "#"};
    for (size_t changes = 1 + below(3); changes > 0; changes--) {
        size_t at = below(size + 1);
        const char *piece = pieces[below(sizeof pieces / sizeof *pieces)];
        size_t length = strlen(piece);
        size_t cut = at < size ? below(size - at < 20 ? size - at : 20) : 0;
        switch (below(4)) {
        case 0: /* insert */
            if (size + length > LARGEST)
                break;
            memmove(text + at + length, text + at, size - at);
            memcpy(text + at, piece, length);
            size += length;
            break;
        case 1: /* cut out */
            memmove(text + at, text + at + cut, size - at - cut);
            size -= cut;
            break;
        case 2: /* any byte */
            if (at < size)
                text[at] = (char)below(256);
            break;
        default: /* end early */
            if (below(8) == 0)
                size = at;
        }
    }
    return size;
}

static size_t read_file(const char *name, char *text) {
    FILE *file = fopen(name, "rb");
    size_t size = file ? fread(text, 1, LARGEST, file) : 0;
    if (file)
        fclose(file);
    return size;
}

static void check_case(const char *path, const HbText *grammar, size_t read_counts[2]) {
    Numbers numbers = {NULL, 0};
    int64_t shape[2] = {-1, -1};
    Message message = {""};
    bool read = flat_csv_read(path, grammar, &numbers, shape, &message);
    read_counts[read]++;
    if (read) {
        CHECK(shape[0] > 0 && shape[1] > 0);
        CHECK(numbers.count == grammar->column_count + (size_t)(shape[0] * shape[1]));
        for (size_t i = 0; i < numbers.count; i++)
            CHECK(numbers.values[i] - numbers.values[i] == 0.0);
    } else {
        CHECK(numbers.count == 0 && strstr(message.text, path) && !strchr(message.text, '\n'));
    }
    free(numbers.values);
}

int main(int count, char **arguments) {
    const char *folder = count > 1 ? arguments[1] : ".";
    char path[4096], seed[LARGEST], text[LARGEST];
    size_t read_counts[2] = {0, 0};
    snprintf(path, sizeof path, "%s/fuzzed.%d", folder, (int)getpid());
    for (int n = 0; n < CASES; n++) {
        static const char *const seeds[] = {"inertias.csv", "shapes.csv", "excel.csv"};
        char name[4096];
        snprintf(name, sizeof name, "%s/%s", folder, seeds[n % 3]);
        size_t size = read_file(name, seed);
        memcpy(text, seed, size);
        size = mutate(text, size);
        remove(path); /* some file systems wait for the disk when a file is overwritten */
        FILE *file = fopen(path, "wb");
        fwrite(text, 1, size, file);
        fclose(file);
        check_case(path, &hb_component.texts[n % 3 == 1], read_counts);
    }
    remove(path);
    printf("%zu read, %zu refused\n", read_counts[1], read_counts[0]);
    CHECK(read_counts[1] > CASES / 10 && read_counts[0] > CASES / 10);
    return report();
}
