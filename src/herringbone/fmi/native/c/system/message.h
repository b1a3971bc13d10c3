/* One line of text that says what went wrong. */
#ifndef MESSAGE_H
#define MESSAGE_H

#include <stdarg.h>

#if defined __GNUC__
#define PRINTF_LIKE(text, first) __attribute__((format(printf, text, first)))
#else
#define PRINTF_LIKE(text, first)
#endif

typedef struct {
    char text[1024];
} Message;

/* A number as messages show it: a NaN without its sign. */
double message_number(double value);

void message_write(Message *message, const char *format, ...) PRINTF_LIKE(2, 3);
void message_write_list(Message *message, const char *format, va_list arguments);

/* Append; a text that is too long loses its end, never the tail. */
void message_end(Message *message, const char *tail);

#endif
