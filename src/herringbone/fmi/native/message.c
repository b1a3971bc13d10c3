#include "message.h"

#include <stdio.h>
#include <string.h>

/* A text that was cut must not end inside a character: hosts decode UTF-8. */
static void drop_partial_character(char *text) {
    size_t end = strlen(text);
    while (end > 0 && ((unsigned char)text[end - 1] & 0xC0) == 0x80)
        end--;
    if (end > 0 && (unsigned char)text[end - 1] >= 0xC0)
        text[end - 1] = '\0';
}

void message_write_list(Message *message, const char *format, va_list arguments) {
    int length = vsnprintf(message->text, sizeof message->text, format, arguments);
    if (length >= (int)sizeof message->text)
        drop_partial_character(message->text);
}

void message_write(Message *message, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    message_write_list(message, format, arguments);
    va_end(arguments);
}
