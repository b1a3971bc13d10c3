#define _GNU_SOURCE /* strtod_l */
#include "platform.h"

#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined __APPLE__
#include <xlocale.h>
#endif
#if defined _WIN32
#include <windows.h>
enum { ON_WINDOWS = true };
#else
enum { ON_WINDOWS = false };
#endif

static bool is_utf8(const unsigned char *text, size_t length) {
    for (size_t i = 0; i < length;) {
        unsigned char lead = text[i++];
        int more = lead < 0x80 ? 0 : lead < 0xE0 ? 1 : lead < 0xF0 ? 2 : 3;
        uint32_t code = more == 0 ? lead : lead & (0x3Fu >> more);
        static const uint32_t smallest[] = {1, 0x80, 0x800, 0x10000};
        if ((lead >= 0x80 && lead < 0xC2) || lead > 0xF4)
            return false;
        for (int k = 0; k < more; k++, i++) {
            if (i >= length || (text[i] & 0xC0) != 0x80)
                return false;
            code = code << 6 | (text[i] & 0x3Fu);
        }
        if (code < smallest[more] || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000))
            return false;
    }
    return true;
}

static FILE *open_file(const char *path) {
#if defined _WIN32
    int length = MultiByteToWideChar(CP_UTF8, 0, path, -1, NULL, 0);
    wchar_t *wide = calloc((size_t)length + 1, sizeof *wide);
    FILE *stream = wide && MultiByteToWideChar(CP_UTF8, 0, path, -1, wide, length)
                       ? _wfopen(wide, L"rb")
                       : NULL;
    free(wide);
    return stream;
#else
    return fopen(path, "rb");
#endif
}

char *platform_read_text(const char *file, Message *message) {
    FILE *stream = open_file(file);
    if (!stream) {
        message_write(message, "cannot open %s", file);
        return NULL;
    }
    size_t capacity = 1u << 16, length = 0;
    char *text = malloc(capacity + 1);
    while (text) {
        length += fread(text + length, 1, capacity - length, stream);
        if (length < capacity || capacity > LARGEST_FILE)
            break;
        char *larger = realloc(text, (capacity *= 4) + 1);
        if (!larger)
            free(text);
        text = larger;
    }
    bool failed = ferror(stream) != 0;
    fclose(stream);
    const char *why = !text                  ? "out of memory"
                      : failed               ? "it cannot be read"
                      : length > LARGEST_FILE ? "it is larger than 16 MiB"
                      : !is_utf8((unsigned char *)text, length) ? "it is no UTF-8 text"
                                                                : NULL;
    if (why) {
        message_write(message, "cannot read %s: %s", file, why);
        free(text);
        return NULL;
    }
    text[length] = '\0';
    if (strncmp(text, "\xEF\xBB\xBF", 3) == 0)
        memmove(text, text + 3, length - 2);
    return text;
}

bool platform_is_file(const char *path) {
    FILE *stream = open_file(path);
    if (!stream)
        return false;
    bool readable = fgetc(stream) != EOF || !ferror(stream); /* a folder opens, but cannot be read */
    fclose(stream);
    return readable;
}

bool platform_is_absolute(const char *path) {
#if defined _WIN32
    if (path[0] == '\\' || (path[0] && path[1] == ':'))
        return true;
#endif
    return path[0] == '/';
}

static int hex_digit(char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

char *platform_path(const char *location) {
    size_t length = strlen(location);
    char *path = malloc(length + 1);
    if (!path)
        return NULL;
    if (strncmp(location, "file:", 5) != 0)
        return memcpy(path, location, length + 1);
    const char *from = location + 5;
    if (strncmp(from, "//", 2) == 0) { /* an authority, empty or a host, ends at a slash */
        const char *host = from + 2;
        size_t named = strcspn(host, "/");
        bool share = ON_WINDOWS && named && strncmp(host, "localhost/", 10) != 0;
        from = share ? from : host + named;
    }
    char *to = path;
    while (*from) {
        int high = from[0] == '%' ? hex_digit(from[1]) : -1;
        int low = high >= 0 ? hex_digit(from[2]) : -1;
        *to++ = low >= 0 ? (char)(16 * high + low) : *from;
        from += low >= 0 ? 3 : 1;
    }
    *to = '\0';
    if (ON_WINDOWS && path[0] == '/' && path[1] && path[2] == ':') /* "/C:/", also as "/C%3A/" */
        memmove(path, path + 1, strlen(path));
    return path;
}

char *platform_join(const char *folder, const char *name) {
    if (platform_is_absolute(name))
        folder = "";
    size_t length = strlen(folder);
    bool separate = length > 0 && folder[length - 1] != '/' && folder[length - 1] != '\\';
    size_t size = length + strlen(name) + 2;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s%s%s", folder, separate ? "/" : "", name);
    return path;
}

static size_t digits(const char *text) {
    return strspn(text, "0123456789");
}

/* Length of a decimal number at the start of the text; 0 if there is none. */
static size_t decimal_length(const char *text) {
    size_t at = text[0] == '+' || text[0] == '-';
    size_t whole = digits(text + at), fraction = 0;
    at += whole;
    if (text[at] == '.') {
        fraction = digits(text + ++at);
        at += fraction;
    }
    if (whole + fraction == 0)
        return 0;
    if (text[at] == 'e' || text[at] == 'E') {
        size_t sign = text[at + 1] == '+' || text[at + 1] == '-';
        size_t exponent = digits(text + at + 1 + sign);
        at += exponent ? 1 + sign + exponent : 0;
    }
    return at;
}

static double convert(const char *text) {
#if defined _WIN32
    _locale_t plain = _create_locale(LC_NUMERIC, "C");
    double value = plain ? _strtod_l(text, NULL, plain) : NAN;
    if (plain)
        _free_locale(plain);
#else
    locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    double value = plain ? strtod_l(text, NULL, plain) : NAN;
    if (plain)
        freelocale(plain);
#endif
    return value;
}

bool platform_number(const char *text, double *value) {
    static const char space[] = " \t\v\f";
    text += strspn(text, space);
    size_t length = decimal_length(text);
    if (length == 0 || length > LONGEST_NUMBER || text[length + strspn(text + length, space)] != '\0')
        return false;
    *value = convert(text);
    return isfinite(*value);
}
