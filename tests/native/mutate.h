/* Mutations of a text, the same in every run. */
#ifndef MUTATE_H
#define MUTATE_H

#include <stdio.h>
#include <string.h>

enum { LARGEST_SEED = 1 << 18 };

static unsigned long long random_state = 0x9E3779B97F4A7C15u;

static size_t below(size_t limit) {
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return (size_t)(random_state % limit);
}

/* Replace text[at ... at + cut - 1]; returns the new size. */
static size_t splice(char *text, size_t size, size_t at, size_t cut, const char *piece,
                     size_t length) {
    if (size - cut + length > LARGEST_SEED)
        return size;
    memmove(text + at + length, text + at + cut, size - at - cut);
    memcpy(text + at, piece, length);
    return size - cut + length;
}

/* Up to 40 lines from the one after `at` on. */
static size_t some_lines(const char *text, size_t size, size_t *at) {
    size_t end = *at, lines = 1 + below(40);
    while (end < size && text[end] != '\n')
        end++;
    *at = end;
    while (end < size && lines > 0)
        lines -= text[end++] == '\n' && end > *at + 1;
    return end - *at;
}

static size_t mutate_once(char *text, size_t size) {
    static const char *const pieces[] = {
        ",", "\"", "\n", "\r", "# units:", "-", "e999", "nan", ".", "\xEF\xBB\xBF", "\xFF", "left",
        "mass kg", "\"\"", " ", "99999999999999999999999999999999", "speed", "shape", "#", "e300",
        "e-300", "0", "0.5"};
    static char copy[LARGEST_SEED];
    size_t at = below(size + 1);
    const char *piece = pieces[below(sizeof pieces / sizeof *pieces)];
    switch (below(7)) {
    case 0:
        return splice(text, size, at, 0, piece, strlen(piece));
    case 1:
        return splice(text, size, at, below((size - at < 20 ? size - at : 20) + 1), "", 0);
    case 2:
        return at < size ? splice(text, size, at, 1, (char[]){(char)below(256)}, 1) : size;
    case 3:
        return below(8) == 0 ? at : size; /* the file ends early */
    case 4:
        while (at < size && (text[at] < '0' || text[at] > '9'))
            at++;
        return at < size ? splice(text, size, at, 1, (char[]){(char)('0' + below(10))}, 1) : size;
    default: { /* lines left out or repeated */
        size_t length = some_lines(text, size, &at);
        memcpy(copy, text + at, length);
        return below(2) ? splice(text, size, at, length, "", 0)
                        : splice(text, size, at, 0, copy, length);
    }
    }
}

/* Mutate text, LARGEST_SEED long; returns the new size. */
static size_t mutate(char *text, size_t size) {
    for (size_t changes = 1 + below(3); changes > 0; changes--)
        size = mutate_once(text, size);
    return size;
}

static size_t read_seed(const char *path, char *text) {
    FILE *file = fopen(path, "rb");
    size_t size = file ? fread(text, 1, LARGEST_SEED, file) : 0;
    if (file)
        fclose(file);
    return size;
}

static void write_mutation(const char *path, const char *text, size_t size) {
    remove(path); /* some file systems wait for the disk when a file is overwritten */
    FILE *file = fopen(path, "wb");
    if (file) {
        fwrite(text, 1, size, file);
        fclose(file);
    }
}

#endif
